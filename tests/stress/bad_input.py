#!/usr/bin/env python3
"""Bad input through the command line: every kind of file empty, truncated, corrupt, of the wrong type, too large, with
NaN, missing; outputs that cannot be written; kill -9 in the middle. Each must end with the exit code it should, with one
clear line on standard error, without a signal and without a temporary file left behind.

usage: bad_input.py PROGRAM SOURCE_FOLDER [WORD]   (WORD: only cases whose name contains it, each with its answer)
"""
import concurrent.futures
import os
import pathlib
import shutil
import signal
import stat
import struct
import subprocess
import sys
import tempfile

import backdrop_cases
import flow_cases
import hostile_cases
import kill_cases

PROGRAM, SOURCE = (os.path.abspath(p) for p in sys.argv[1:3])
WORD = sys.argv[3] if len(sys.argv) > 3 else ''
VERBOSE = len(sys.argv) > 3  # else only what fails is printed: a log is read from its end
DATA = os.path.join(SOURCE, 'experiments', 'data')
WORK = pathlib.Path(tempfile.mkdtemp(prefix='airlight_bad_input_', dir='/dev/shm' if os.access('/dev/shm', os.W_OK)
                                     and 'TMPDIR' not in os.environ else None))
failures = []
cases = []


def run(arguments, timeout=60, **more):
    return subprocess.run([PROGRAM, *(os.fsencode(a) for a in arguments)], cwd=WORK, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                          timeout=timeout, **more)


def fail(name, text):
    failures.append(name)
    sys.stdout.write(f'FAILED {name}: {text}\n')  # one write: two threads print
    sys.stdout.flush()


def ok(name, text):
    if VERBOSE:
        sys.stdout.write(f'ok     {name}: {text}\n')


def case(name, arguments, code=2, says='', other_codes=(), **more):
    """Queues one run that must end with `code` and one line on standard error that contains `says`; exit code 0 without
    a line is right too where 0 is in other_codes."""
    if WORD in name:
        cases.append((name, [str(a) for a in arguments], code, says, other_codes, more))


def check(item):
    name, arguments, code, says, other_codes, more = item
    try:
        done = run(arguments, **more)
    except subprocess.TimeoutExpired:
        return fail(name, 'hangs')
    except (OSError, subprocess.SubprocessError) as reason:
        return fail(name, f'could not be started: {reason!r}')
    error = done.stderr.decode(errors='replace')
    if done.returncode in other_codes and done.returncode == 0 and not error:
        return ok(name, 'accepted')
    lines = error.splitlines()
    if done.returncode != code and done.returncode not in other_codes:
        return fail(name, f'exit code {done.returncode}, expected {code}: {error[:300]!r}')
    if len(lines) != 1 or not error.endswith('\n'):
        return fail(name, f'{len(lines)} lines on standard error: {error[:400]!r}')
    if not lines[0].startswith('airlight: ') or 'unexpected failure' in lines[0] or len(lines[0]) > 600:
        return fail(name, f'not a clear line: {lines[0][:400]!r}')
    if says not in lines[0]:
        return fail(name, f'does not say {says!r}: {lines[0]!r}')
    ok(name, lines[0])


def write(name, content):
    path = WORK / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(content.encode() if isinstance(content, str) else content)
    return name


def exr(width, height, value=0.5, declared=None):
    """A small OpenEXR file, uncompressed floats, written from its specification."""
    w, h = declared or (width, height)

    def attribute(name, kind, data):
        return name.encode() + b'\0' + kind.encode() + b'\0' + struct.pack('<i', len(data)) + data

    channels = b''.join(c + b'\0' + struct.pack('<iB3xii', 2, 0, 1, 1) for c in (b'B', b'G', b'R')) + b'\0'
    window = struct.pack('<4i', 0, 0, w - 1, h - 1)
    header = struct.pack('<ii', 20000630, 2) + attribute('channels', 'chlist', channels)
    header += attribute('compression', 'compression', b'\0') + attribute('dataWindow', 'box2i', window)
    header += attribute('displayWindow', 'box2i', window) + attribute('lineOrder', 'lineOrder', b'\0')
    header += attribute('pixelAspectRatio', 'float', struct.pack('<f', 1))
    header += attribute('screenWindowCenter', 'v2f', struct.pack('<2f', 0, 0))
    header += attribute('screenWindowWidth', 'float', struct.pack('<f', 1)) + b'\0'
    line = 8 + 12 * width
    begin = len(header) + 8 * height
    body = b''.join(struct.pack('<Q', begin + y * line) for y in range(height))
    for y in range(height):
        row = [value] * (3 * width)
        body += struct.pack('<ii', y, 12 * width) + struct.pack(f'<{3 * width}f', *row)
    return header + body


CAMERA = '[film]\nwidth = 8\nheight = 6\n[camera]\nposition = [0, 0, 4]\nlook_at = [0, 0, 0]\n'
LIGHT = '[[light]]\ntype = "point"\nposition = [1, 2, 1]\nintensity = 5\n'
FOG = '[[medium]]\ntype = "homogeneous"\nsigma_t = 0.5\nregion = { type = "sphere", center = [0, 0, 0], radius = 1 }\n'
SCENE = CAMERA + LIGHT + FOG
CSV = open(os.path.join(SOURCE, 'experiments', 'scenes', 'blobs.csv')).read()
OBJ = 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n'
OFF = 'OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n'
PLY = ('ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n'
       'element face 4\nproperty list uchar int vertex_indices\nend_header\n'
       '0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n')
EXPERIMENT = ('title = "t"\n[[scene]]\nfile = "scenes/one.toml"\n[reference]\nrenderer = "path_tracer"\n'
              'settings = { samples = 64 }\n[[method]]\nrenderer = "ray_marcher"\n[profile.quick]\nruns = 1\n')


COEFFICIENTS = 'i,j,k,coefficient\n0,0,0,2\n1,0,1,0.5\n2,1,1,-0.25\n'


def scene_with(kind, file):
    if kind == 'csv':
        medium = f'[[medium]]\ntype = "gaussians"\nfile = "{file}"\n'
    elif kind == 'coefficients':
        medium = f'[[medium]]\ntype = "legendre"\nlo = [-1, -1, -1]\nhi = [1, 1, 1]\nsize = [3, 2, 2]\nfile = "{file}"\n'
    elif kind == 'vdb':
        medium = f'[[medium]]\ntype = "grid"\nfile = "{file}"\n'
    elif kind == 'environment':
        return CAMERA + FOG + f'[[light]]\ntype = "environment"\nfile = "{file}"\n'
    else:
        return SCENE + f'[[surface]]\ntype = "mesh"\nfile = "{file}"\n'
    return CAMERA + LIGHT + medium


def damaged(good):
    """Name and bytes of what can be wrong with a file of any kind."""
    good = good if isinstance(good, bytes) else good.encode()
    flipped = bytearray(good)
    for at in [20, *range(len(good) // 3, len(good), max(1, len(good) // 7))]:
        flipped[at] ^= 0x5a
    yield 'empty', b'', ()
    yield 'truncated', good[:len(good) * 2 // 3], ()
    yield 'cut by one', good[:-2], (0,)  # a text may lose its last newline
    yield 'corrupt', bytes(flipped), ()
    yield 'noise', bytes((i * 7919 + (i >> 3) * 31) % 256 for i in range(3000)), ()
    yield 'of another kind', b'%PDF-1.4 nothing of the sort\n' * 50, ()
    yield 'ten times', good * 10, (0,)  # trailing bytes may be read over


def queue_files():
    out = ['-m', 'deterministic', '-o', 'never.exr']
    write('good.toml', SCENE)
    for what, content, others in damaged(SCENE):
        case(f'scene, {what}', ['render', write(f'scene {what}.toml', content), *out], other_codes=others)
    for what, text in {'nan': SCENE.replace('intensity = 5', 'intensity = nan'),
                       'infinite': SCENE.replace('sigma_t = 0.5', 'sigma_t = inf'),
                       'wrong type': SCENE.replace('width = 8', 'width = "eight"'),
                       'film ten times too large': SCENE.replace('width = 8', 'width = 163840'),
                       'number too large': SCENE.replace('width = 8', 'width = 99999999999999999999'),
                       'asset is a folder': scene_with('csv', '.'), 'asset is a device': scene_with('csv', '/dev/null'),
                       'deeply nested': 'a = ' + '[' * 5000 + ']' * 5000}.items():
        case(f'scene, {what}', ['render', write(f'scene {what}.toml', text), *out])
    case('scene, missing', ['render', 'no.toml', *out], says='no.toml')
    case('scene, a folder', ['render', '.', *out])
    case('explain, corrupt scene', ['explain', write('half.toml', SCENE[:100])])
    case('choose, corrupt scene', ['choose', write('half.toml', SCENE[:100]), '--budget', '1s'])
    vdb = open(os.path.join(DATA, 'plume_0024.vdb'), 'rb').read()
    kinds = {'csv': ('csv', CSV), 'coefficients': ('csv', COEFFICIENTS), 'vdb': ('vdb', vdb),
             'environment': ('exr', exr(8, 4)), 'obj': ('obj', OBJ), 'off': ('off', OFF), 'ply': ('ply', PLY)}
    for kind, (ending, good) in kinds.items():
        os.makedirs(WORK / kind, exist_ok=True)
        files = dict((what, (content, others)) for what, content, others in damaged(good))
        if kind == 'csv':
            files['nan'] = (CSV.rstrip('\n') + '\nnan,0,0,1,1\n', ())
            files['too many columns'] = (CSV.rstrip('\n') + '\n0,0,0,1,1,7,8\n', ())
        elif kind == 'coefficients':
            files['nan'] = (COEFFICIENTS + '1,1,1,nan\n', ())
            files['index out of range'] = (COEFFICIENTS + '1,1,2,1\n', ())
            files['twice'] = (COEFFICIENTS + '0,0,0,1\n', ())
        elif kind == 'environment':
            files['nan'] = (exr(8, 4, float('nan')), ())
            files['infinite'] = (exr(8, 4, float('inf')), ())
            files['negative'] = (exr(8, 4, -1), ())
            files['declared ten times larger'] = (exr(8, 4, declared=(80, 40)), ())
            files['declared enormous'] = (exr(8, 4, declared=(655360, 655360)), ())
        elif kind in ('obj', 'off', 'ply'):
            files['nan'] = (good.replace('1 0 0', '1 nan 0', 1), ())
            index = {'obj': ('f 1 3 2', 'f 1 3 40'), 'off': ('3 0 2 1', '3 0 2 40'), 'ply': ('3 0 2 1', '3 0 2 40')}
            files['index ten times too large'] = (good.replace(*index[kind]), ())
            files['declared ten times larger'] = (good.replace('4 4 0', '40 40 0').replace('vertex 4', 'vertex 40'),
                                                  (0,) if kind == 'obj' else ())
        for what, (content, others) in files.items():
            file = write(f'{kind}/{what}.{ending}', content)
            scene = write(f'{kind} {what}.toml', scene_with(kind, file))
            if what == 'cut by one' and ending in ('exr', 'vdb', 'ply', 'off', 'obj', 'csv'):
                others = (0,) if ending in ('csv', 'obj', 'off', 'ply') else ()
            # Half of a table of Gaussians, or of an OBJ file, may be a whole smaller one.
            if ending in ('csv', 'obj') and what == 'truncated':
                others = (0,)
            case(f'{kind}, {what}', ['render', scene, *out], other_codes=others)
        case(f'{kind}, missing', ['render', write(f'{kind} missing.toml', scene_with(kind, 'no such file')), *out],
             says='no such file')
        # Sound files are taken, or all of the above shows nothing.
        cases.append((f'{kind}, sound', ['render', write(f'{kind} sound.toml',
                      scene_with(kind, write(f'{kind}/sound.{ending}', good))), *out[:3], f'{kind}.exr'], 0, '', (0,), {}))
    image = exr(8, 6)
    write('good.exr', image)
    for what, content, others in damaged(image):
        file = write(f'image {what}.exr', content)
        case(f'compare, image {what}', ['compare', file, 'good.exr'], other_codes=others)
        case(f'convert, image {what}', ['convert', file, 'never.png'], other_codes=others)
    case('compare, nan', ['compare', write('nan.exr', exr(8, 6, float('nan'))), 'good.exr'], other_codes=(0, 1))
    case('compare, sizes differ', ['compare', write('large.exr', exr(80, 60)), 'good.exr'])
    case('compare, missing', ['compare', 'no.exr', 'good.exr'], says='no.exr')
    case('convert, missing', ['convert', 'no.exr', 'never.png'], says='no.exr')
    case('convert, a folder', ['convert', '.', 'never.png'])
    fit = ['fit', '-n', '20', '--out', 'never fitted']
    for what, content, others in damaged(vdb):
        case(f'fit, {what}', [*fit, write(f'fit {what}.vdb', content)], other_codes=others)
    sound = write('sound fit.vdb', vdb)
    case('fit, missing', [*fit, 'no.vdb'], says='no.vdb')
    case('fit, the second of two is missing', [*fit, sound, 'no.vdb'], says='no.vdb')
    case('fit, the same twice', [*fit, sound, sound], says='expected another name')
    case('fit, a folder', [*fit, '.'])
    case('fit, no grid', [*fit, write('fit.toml', scene_with('csv', write('fit.csv', CSV)))], says='expected a grid')
    case('fit, no Gaussians', ['fit', sound, '-n', '0', '--out', 'never fitted'], says='expected 1 to 65536')
    case('fit, a million Gaussians', ['fit', sound, '-n', '1000000', '--out', 'never fitted'], says='expected 1 to 65536')
    case('fit, no method', ['fit', sound, '--method', 'lbgfs', '--out', 'never fitted'], says='lbfgs')
    case('fit into a file', ['fit', sound, '-n', '20', '--out', 'sound fit.vdb'])
    case('fit, no folder', ['fit', sound], says='--out')
    case('fit, sound', ['fit', sound, '-n', '20', '--out', 'fitted'], 0, other_codes=(0,))
    oracles = '{"vectors": [{"id": "a", "kind": "od", "input": {}, "expected": {}}]}'
    for what, content, _ in damaged(oracles):
        case(f'verify, {what}', ['verify', write(f'oracle {what}.json', content)])
    case('verify, wrong type', ['verify', write('oracle type.json', '{"vectors": 3}')])
    case('verify, nan', ['verify', write('oracle nan.json', '{"vectors": [{"id": NaN}]}')])
    case('verify, not a list of vectors', ['verify', write('oracle list.json', '[1, 2, 3]')])
    case('verify, missing', ['verify', 'no.json'], says='no.json')
    run(['render', 'good.toml', '-m', 'path_tracer', '--samples', '0..64', '-o', 'part.exr'])
    trace = ['render', 'good.toml', '-m', 'path_tracer', '--samples', '64', '-o', 'traced.exr', '--cache']
    run([*trace, 'kept'])
    (kept,) = (WORK / 'kept/samples').iterdir()
    for what, content, _ in damaged(kept.read_bytes()):
        write(f'cache {what}/samples/{kept.name}', content)
        # Set aside with one line, and computed anew.
        case(f'cache, {what}', [*trace, f'cache {what}'], code=0, says='damaged')
    write('cache file', 'no folder')
    case('cache, a file where a folder should be', [*trace, 'cache file'])
    part = (WORK / 'part.exr.samples').read_bytes()
    for what, content, _ in damaged(part):
        case(f'merge, samples {what}', ['merge', 'good.toml', write(f'samples {what}', content), '-o', 'never.exr'])
    case('merge, missing', ['merge', 'good.toml', 'no.samples', '-o', 'never.exr'], says='no.samples')


def project(name, experiment=EXPERIMENT):
    write(f'{name}/experiments/README.md', '')
    write(f'{name}/experiments/scenes/one.toml', SCENE)
    write(f'{name}/experiments/g/e.toml', experiment)
    return ['experiment', 'run', 'g/e', '--root', name]


def queue_scripts():
    write('author base.toml', CAMERA)
    good = ('{"op": "scene", "base": "author base.toml"}\n'
            '{"op": "paint", "stroke": [[0, 0, 0], [1, 0, 0]], "a": 2, "c": 1}\n'
            '{"op": "import", "file": "frames.csv", "frame": 1.5}\n')
    frames = 'frame,id,x,y,z,radius,density\n1,1,0,0,0,1,1\n2,1,1,0,0,1,1\n'
    write('frames.csv', frames)
    out = ['-o', 'authored never.toml']
    for what, content, _ in damaged(good):
        case(f'script, {what}', ['author', write(f'script {what}.jsonl', content), *out])
    for what, content, _ in damaged(frames):
        script = good.replace('frames.csv', write(f'frames {what}.csv', content))
        case(f'frames, {what}', ['author', write(f'script of frames {what}.jsonl', script), *out])
    fitted = 'id,center_x,center_y,center_z,width,amplitude\n1,0,0,0,1,1\n2,1,0,0,1,1\n3,1,0,0,1,2\n'
    for number, (what, content, _) in enumerate(damaged(fitted)):
        write(f'fitted {number} 001.csv', fitted)
        write(f'fitted {number} 002.csv', content)
        script = good.replace('frames.csv', f'fitted {number} ###.csv')
        case(f'frames of a fit, {what}', ['author', write(f'script of a fit {what}.jsonl', script), *out])
    for what, text in {'nan': good.replace('"c": 1', '"c": NaN'), 'huge': good.replace('"a": 2', '"a": 1e12'),
                       'nested': '[' * 1000000, 'nested and closed': '[' * 1000000 + ']' * 1000000,
                       'endless flight': good + '{"op": "airbrush", "pos": [0, 0, 0], "rate": 1e-9, "speed": 1e308, "diffusion": '
                                                '0, "dt": 1e9, "steps": 3, "a": 1, "c": 1}\n', 'no base': good.replace('author base', 'none'),
                       'base is a folder': good.replace('author base.toml', '.'), 'zero byte': good + '\0\n',
                       'wrong type': good.replace('[1, 0, 0]', '"x"')}.items():
        case(f'script, {what}', ['author', write(f'script {what}.jsonl', text), *out])
    case('script, missing', ['author', 'no.jsonl', *out], says='no.jsonl')
    write('good.jsonl', good)
    for where in ('/dev/full/made.toml', 'no folder/made.toml', 'author base.toml'):
        case(f'script, to {where}', ['author', 'good.jsonl', '-o', where])


def queue_experiments():
    for i, (what, content, others) in enumerate(damaged(EXPERIMENT)):
        case(f'experiment, {what}', project(f'project{i}', content), other_codes=others)
    case('experiment, scene missing', project('p1', EXPERIMENT.replace('one.toml', 'two.toml')), says='two.toml')
    case('experiment, wrong type', project('p2', EXPERIMENT.replace('samples = 64', 'samples = "many"')))
    case('experiment, ten times too large', project('p3', EXPERIMENT.replace('samples = 64', 'samples = 1e300')))
    case('experiment, nan', project('p4', EXPERIMENT + '[[gate]]\nmethod = "ray_marcher"\nmetric = "rel_l2"\n'
                                                       'at_most = nan\n'))
    arguments = project('p5')
    write('p5/results', 'a file where a folder should be')
    case('experiment, results is a file', arguments)
    arguments = project('p6')
    write('p6/results/cache/samples', 'a file where a folder should be')
    case('experiment, cache is a file', arguments)
    arguments = project('p7', EXPERIMENT.replace('"path_tracer"', '"deterministic"').replace('samples = 64', ''))
    write('p7/results/cache/references', 'a file where a folder should be')
    case('experiment, cache of another reference is a file', arguments)
    case('experiment, missing', ['experiment', 'run', 'g/none', '--root', 'p4'])


def queue_outputs():
    os.makedirs(WORK / 'folder.exr', exist_ok=True)
    os.makedirs(WORK / 'folder.png', exist_ok=True)
    render = ['render', 'good.toml', '-m', 'deterministic', '-o']
    case('output is a folder', [*render, 'folder.exr'])
    case('preview is a folder', [*render, 'beside.exr', '--png', 'folder.png'])
    case('output in no folder', [*render, 'none/a.exr'])
    try:
        for name in ('full.exr', 'full.png'):
            os.mknod(WORK / name, 0o666 | stat.S_IFCHR, os.stat('/dev/full').st_rdev)
            with open(WORK / name, 'wb'):
                pass
        case('output to a full device', [*render, 'full.exr'], says='No space left')
        case('preview to a full device', [*render, 'beside2.exr', '--png', 'full.png'], says='No space left')
    except OSError:  # only root makes devices, and not on every file system
        print('test skipped: output to a full device: no such device can be made here')
    case('conversion to a folder', ['convert', 'good.exr', 'folder.png'])
    if os.path.isdir('/proc/self'):
        case('output to a folder that takes no files', [*render, '/proc/self/a.exr'])
    case('standard output full', ['compare', 'good.exr', 'good.exr'], says='standard output')
    # A disk that is full, by the limit on the size of a file: 4 KiB.
    case('disk full in the middle', [*render, 'limited.exr', '--override', 'film.width=256', '--override',
                                     'film.height=256'], says='limited.exr', preexec_fn=limit_files)
    case('disk full, samples', ['render', 'good.toml', '-m', 'path_tracer', '--samples', '0..64', '-o', 'limited2.exr'],
         says='limited2.exr', preexec_fn=limit_files)
    os.makedirs(WORK / 'read only', exist_ok=True)
    os.chmod(WORK / 'read only', 0o555)
    if os.geteuid() != 0:
        case('output to a read-only folder', [*render, 'read only/a.exr'], says='Permission denied')
        return
    # Root may write anywhere: as nobody, where the program can be started so.
    os.chmod(WORK, 0o755)
    try:
        started = run(['--version'], preexec_fn=be_nobody).returncode == 0
    except (OSError, subprocess.SubprocessError):
        started = False
    if started:
        case('output to a read-only folder', [*render, 'read only/a.exr'], says='Permission denied',
             preexec_fn=be_nobody)
    else:
        print('not run: output to a read-only folder (this is root, and nobody cannot start the program)', flush=True)


def be_nobody():
    os.setgroups([])
    os.setgid(65534)
    os.setuid(65534)


def limit_files():
    import resource
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096))


def main():
    try:
        queue_files()
        queue_scripts()
        queue_experiments()
        flow_cases.queue(case, write, limit_files)
        backdrop_cases.queue(case, write, SCENE)
        queue_outputs()
        hostile_cases.queue(WORK, SOURCE, case, write, project, scene_with, SCENE, EXPERIMENT)
        # Standard output to a full device needs its own call.
        for item in [c for c in cases if c[0] == 'standard output full']:
            cases.remove(item)
            with open('/dev/full', 'w') as full:
                done = subprocess.run([PROGRAM, *item[1]], cwd=WORK, stdout=full, stderr=subprocess.PIPE)
            if done.returncode != 2 or done.stderr.count(b'\n') != 1:
                fail(item[0], f'exit code {done.returncode}: {done.stderr!r}')
        with concurrent.futures.ThreadPoolExecutor(2) as pool:
            list(pool.map(check, cases))
        if WORD in 'kill and resume':
            killed = kill_cases.KillAndResume(PROGRAM, WORK, run, project, fail, ok)
            killed.render()
            killed.experiment(EXPERIMENT)
            killed.fit()
        left = [str(f.relative_to(WORK)) for f in WORK.rglob('*.tmp') if 'broken' not in f.parts[:-1] and
                not f.name.startswith('broken')]
        if left:
            fail('temporary files', f'left behind: {left}')
        print(f'{len(cases)} cases, {len(failures)} failed')
        return 1 if failures else 0
    finally:
        shutil.rmtree(WORK, ignore_errors=True)


if __name__ == '__main__':
    sys.exit(main())
