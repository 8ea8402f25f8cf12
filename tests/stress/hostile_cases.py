"""Cases of bad_input.py that were meant to break the program, and most of which once did: nesting that ends the stack, files that never
end, text that draws on the terminal. Further ones are made by fuzz/fuzz.py; what it finds comes here."""
import os
import re
import struct

PLY = ('ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n'
       'element face {}\nproperty list uchar int vertex_indices\nend_header\n')
OUT = ['-m', 'deterministic', '-o', 'never.exr']


def ply(faces):
    vertices = struct.pack('<12f', 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1)
    return PLY.format(len(faces)).encode() + vertices + b''.join(struct.pack(f'<B{len(f)}i', len(f), *f) for f in faces)


def queue_nesting(case, write, project, scene, experiment):
    many, brackets = '.'.join(['a'] * 100000), '[' * 100000 + ']' * 100000
    for what, text in {'a key of 100,000 parts': many + ' = 1\n' + scene, 'a header of 100,000 parts': scene + f'[{many}]\n',
                       '100,000 lists': f'name = {brackets}\n' + scene, '100,000 tables': 'name = ' + '{a=' * 100000,
                       'quoted keys': '.'.join(['"a"'] * 100000) + ' = 1\n' + scene}.items():
        case(f'nested scene, {what}', ['render', write(f'nested {what}.toml', text), *OUT], says='more than 32')
        case(f'nested experiment, {what}', project(f'nested {what}', text.replace(scene, experiment)), says='more than 32')
        case(f'nested base scene, {what}', ['author', write(f'nested {what}.jsonl', '{"op": "scene", "base": "nested ' + what + '.toml"}\n'),
                                            '-o', 'sub/never.toml'], says='more than 32')
    deep = '.'.join(['a'] * 20000)
    case('nested override', ['render', 'good.toml', *OUT, '--override', f'medium.0.phase={"[" * 20000}'], says='more than 32')
    case('nested override, keys', ['render', 'good.toml', *OUT, '--override', 'medium.0.phase={ ' + deep + ' = 1 }'], says='more than 32')
    case('nested path of an override', ['render', 'good.toml', *OUT, '--override', f'{deep}=1'], says='there is no')
    for what, text in {'lists': '{"vectors": ' + brackets + '}', 'an id': '{"format": "airlight-fogshop-vectors-1", "vectors": [{"id": ' + brackets + '}]}',
                       'objects': '{"a":' * 100000, 'open lists': '[' * 1000000}.items():
        case(f'nested vectors, {what}', ['verify', write(f'nested {what}.json', text)], says='more than 32 levels')


def queue_not_files(work, case, write, scene_with, scene):
    """Pipes nobody writes to, devices without an end, files that may not be read."""
    os.mkfifo(work / 'pipe')
    for name in ('pipe', '/dev/zero'):
        case(f'no file, {name}: scene', ['render', name, *OUT], says='expected a file')
        case(f'no file, {name}: vectors', ['verify', name], says='expected a file')
        case(f'no file, {name}: script', ['author', name, '-o', 'never.toml'], says='expected a file')
        case(f'no file, {name}: samples', ['merge', 'good.toml', name, '-o', 'never.exr'], says='expected a file')
        case(f'no file, {name}: image', ['convert', name, 'never.png'], says='not a regular file')
        for kind in ('csv', 'vdb', 'environment'):
            case(f'no file, {name}: {kind}', ['render', write(f'{kind} of {name[-4:]}.toml', scene_with(kind, name)), *OUT])
        for ending in ('off', 'obj', 'ply'):
            os.makedirs(work / 'pipes', exist_ok=True)
            if name == 'pipe':
                os.mkfifo(work / f'pipes/pipe.{ending}')
                case(f'no file, pipe: {ending}', ['render', write(f'{ending} of pipe.toml', scene_with('mesh', f'pipes/pipe.{ending}')), *OUT],
                     says='expected a file')
    case('too long a scene', ['render', write('long.toml', '#' * (1 << 24) + '\n' + scene), *OUT], says='bytes')


def queue_numbers(case):
    for threads in ('-1', '5000', '2147483647', '99999999999'):
        case(f'threads {threads}', ['render', 'good.toml', *OUT, '--threads', threads], says='--threads')
    case('more threads than processors', ['render', 'good.toml', *OUT[:2], '-o', 'many.exr', '--threads', '4000'], code=0, other_codes=(0,))
    for exposure in ('nan', 'inf', '1e300', '-101'):
        case(f'exposure {exposure}', ['render', 'good.toml', *OUT, '--png', 'never.png', '--exposure', exposure], says='[-100, 100]')
        case(f'exposure {exposure}, convert', ['convert', 'good.exr', 'never.png', '--exposure', exposure], says='[-100, 100]')


def queue_text(case, write, scene_with, scene):
    """What is quoted in a message stays on its line and draws nothing."""
    nasty = 'a\x1b[31m\rb\nc\x07\u202e\u2028'
    toml = ''.join(f'\\u{ord(c):04x}' if c < ' ' or c > '~' else c for c in nasty)
    case('control characters, key', ['render', write('key.toml', f'"{toml}" = 1\n' + scene), *OUT], says='unknown key')
    case('control characters, value', ['render', write('value.toml', scene.replace('"point"', f'"{toml}"')), *OUT], says='expected one of')
    case('control characters, file', ['render', write('asset.toml', scene_with('csv', toml)), *OUT], says='there is no')
    case('control characters, name of the scene', ['render', f'no {nasty}.toml', *OUT], says='no such file')
    case('control characters, override', ['render', 'good.toml', *OUT, '--override', f'{nasty}={nasty}'], says='override')
    case('control characters, value of a setting', ['render', 'good.toml', *OUT, '--set', f'max_evaluations={nasty}'], says='expected an integer')
    case('control characters, setting', ['render', 'good.toml', *OUT, '--set', f'{nasty}=1'], says='unknown setting')
    case('control characters, method', ['render', 'good.toml', '-m', nasty, '-o', 'never.exr'])
    case('control characters, command', [nasty])
    case('control characters, option', ['render', f'--{nasty}'])
    case('control characters, vectors', ['verify', write('nasty.json', '{"format": "' + toml + '", "vectors": []}')])
    case('control characters, id', ['verify', write('id.json', '{"format": "airlight-fogshop-vectors-1", "vectors": [{"id": "' + toml +
                                                    '", "kind": "' + toml + '"}]}')], says='unknown kind')
    case('not UTF-8', ['render', b'no \xff\xfe.toml'.decode('utf-8', 'surrogateescape'), *OUT], says='no ??.toml')
    case('a value of 100,000 characters', ['render', 'good.toml', *OUT, '--set', 'max_evaluations=' + 'x' * 100000], says='expected an integer')
    case('a key of 100,000 characters', ['render', write('longkey.toml', 'a' * 100000 + ' = 1\n' + scene), *OUT], says='expected one of')


def queue(work, source, case, write, project, scene_with, scene, experiment):
    queue_nesting(case, write, project, scene, experiment)
    queue_not_files(work, case, write, scene_with, scene)
    queue_numbers(case)
    queue_text(case, write, scene_with, scene)
    for what, faces in {'faces without area': [(0, 0, 0)] * 4, 'polygons without area': [(0, 1, 0, 1), (2, 2, 2, 2, 2)],
                        'one line': [(0, 1, 1), (0, 0, 1, 1)]}.items():
        write(f'{what}.ply', ply(faces))
        case(f'ply, {what}', ['render', write(f'{what}.toml', scene_with('mesh', f'{what}.ply')), *OUT], says='no triangle with an area')
    # Behind the name of the transform stands its translation, then its scale. No checksum lies beside these.
    plume = open(os.path.join(source, 'experiments', 'data', 'plume_0024.vdb'), 'rb').read()
    begin = re.search(rb'[A-Za-z]+TranslateMap', plume).end() + 24
    for what, scale in {'zero': (0, 0, 0), 'tiny': (1e-200,) * 3, 'flat': (1, 1, 0), 'infinite': (1, float('inf'), 1)}.items():
        write(f'{what} scale.vdb', plume[:begin] + struct.pack('<3d', *scale) + plume[begin + 24:])
        case(f'vdb, transform {what}', ['render', write(f'{what} scale.toml', scene_with('vdb', f'{what} scale.vdb')), *OUT],
             says='voxels come to be 1e-200 m apart' if what == 'tiny' else "grid 'density'")
