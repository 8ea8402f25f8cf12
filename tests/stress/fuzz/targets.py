"""What is mutated and how the program is run on it. A target is a function (r, box) that writes the input into box.folder and returns the
arguments of the program; all randomness comes from r. Work is kept tiny by settings that the mutations do not reach."""
import json
import os
import pathlib
import re
import shutil
import struct
import subprocess

import mutate

METHODS = ['deterministic', 'path_tracer', 'ray_marcher', 'fogshop', 'shadow_planes']
SMALL = {'deterministic': ['max_evaluations=300', 'relative_tolerance=0.01'], 'path_tracer': ['samples=64', 'max_order=8'],
         'ray_marcher': ['steps=4', 'shadow_steps=2', 'environment_directions=4'], 'fogshop': [], 'shadow_planes': []}
CAMERA = '[film]\nwidth = 2\nheight = 2\n[camera]\nposition = [0, 0, 4]\nlook_at = [0, 0, 0]\n'
LIGHT = '[[light]]\ntype = "point"\nposition = [1, 2, 1]\nintensity = 5\n'
FOG = '[[medium]]\ntype = "homogeneous"\nsigma_t = 0.5\nregion = { type = "sphere", center = [0, 0, 0], radius = 1 }\n'
OBJ = 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 1 1 0\nf 1 3 2\nf 1/1 2/2 4/3\nf -5 -2 -3\nf 2 3 4\nf 1 2 5 3\nusemtl x\n'
OFF = 'OFF\n5 5 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 1 0\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n4 0 1 4 2\n'
PLY_HEAD = ('ply\nformat {} 1.0\ncomment a tetrahedron and a square\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n'
            'property uchar red\nelement face 5\nproperty list uchar int vertex_indices\nend_header\n')
VERTICES = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 0)]
FACES = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3), (0, 1, 4, 2)]
SCRIPT = ('{"op": "scene", "base": "base.toml"}\n'
          '{"op": "paint", "stroke": [[0, 0, 0], [1, 0, 0]], "a": 2, "c": 1, "spacing": 0.5, "jitter": 0.1, "seed": 3, "tag": "x"}\n'
          '{"op": "copy", "tag": "x", "transform": {"rotation": {"axis": [0, 1, 0], "angle": 1}, "scale": 2, "translation": [1, 0, 0]}}\n'
          '{"op": "airbrush", "pos": [0, 0, 0], "rate": 2, "speed": 1, "diffusion": 0.1, "dt": 0.1, "steps": 3, "a": 1, "c": 1}\n'
          '{"op": "import", "file": "frames.csv", "frame": 1.5}\n{"op": "undo"}\n{"op": "freeze"}\n')
FRAMES = 'frame,id,x,y,z,radius,density\n1,1,0,0,0,1,1\n2,1,1,0,0,1,1\n2,2,1,0.5,0,1,1\n'
CSV = '\n'.join(['center_x,center_y,center_z,width,amplitude', '# a comment', '0,0,0,1,1', '0.5,0.1,-0.2,0.4,2', '-1,0.5,0,0.7,-0.3', ''])
NASTY_NAMES = ['`touch run`', '$(touch run)', ';touch run', '"', "'", '..', '../evil', '/evil', 'state', '%d', 'a b', '-o', '.hidden', '####']
VICTIM = 'of somebody else'
PLOT = '[[plot]]\nx = "setting"\ny = "rel_l2"\nname = "p"\n'
EXPERIMENT = ('title = "t"\nmetrics = ["rel_l2", "bias"]\n[[scene]]\nfile = "scenes/one.toml"\nname = "one"\n'
              'overrides = { "medium.0.sigma_t" = 1 }\n[reference]\nrenderer = "deterministic"\nsettings = { max_evaluations = 300 }\n'
              '[[method]]\nname = "m"\nrenderer = "ray_marcher"\nsweep = { key = "steps", values = [4, 8] }\n'
              '[profile.quick]\nbudget = 0\n'
              '[[gate]]\nmethod = "m"\nsetting = 8\nmetric = "rel_l2"\nat_most = 0.5\nwhy = "w"\n'
              '[[expected]]\nwhat = "x"\npaper = "4 %"\nscene = "one"\nmethod = "m"\nsetting = 8\nmetric = "rel_l2"\n')


class Box:
    """A folder to work in, and what is read or made once."""

    def __init__(self, folder, source, program):
        self.folder, self.source, self.program = pathlib.Path(folder), pathlib.Path(source), program
        self.folder.mkdir(parents=True, exist_ok=True)
        data = self.source / 'experiments' / 'data'
        self.scenes = re.findall(r'```toml\n(.*?)```', (self.source / 'scene' / 'README.md').read_text().replace('../data/', 'data/'), re.S)
        self.vectors = [json.loads((self.source / 'tests' / 'vectors' / f'{name}.json').read_text())
                        for name in ('references', 'shadow_planes', 'fogshop', 'wavelet_fog', 'legendre_fluids',
                                     'compensated_ray_marching')]
        for name in ('blobs.csv', 'base.toml'):
            self.write(name, CSV if name == 'blobs.csv' else CAMERA + FOG)
        os.makedirs(self.folder / 'data', exist_ok=True)
        for name in ('oblong.off', 'synthetic_satin.brdf', 'plume_0024.vdb'):
            shutil.copy(data / name, self.folder / 'data' / name)
        self.write('data/courtyard.exr', exr(4, 2))
        brdf = '2 3\n' + '0.1 0.2 0.3\n' * 12
        self.brdf = '# table\n' + brdf
        self.write('data/satin.brdf', brdf)
        self.vdb = [(data / 'plume_0024.vdb').read_bytes()]
        self.write('seed.toml', CAMERA + LIGHT + FOG)
        self.write('victim', VICTIM)
        self.samples = self.journal = None
        self.made = {}
        self.settings = {method: self.settings_of(method) for method in METHODS}

    def write(self, name, content):
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content.encode('utf-8', 'surrogatepass') if isinstance(content, str) else content)
        return name

    def run(self, *arguments):
        subprocess.run([self.program, *arguments], cwd=self.folder, check=True, capture_output=True)

    def settings_of(self, method):
        """Names and choices, as the program explains them."""
        done = subprocess.run([self.program, 'explain', 'seed.toml', '-m', method], cwd=self.folder, check=True, capture_output=True, text=True)
        lines = re.findall(r'^    ([a-z]\w*) = [^;]*; ([^;]*); ', done.stdout, re.M)
        return [(name, re.findall(r'[\w.]+', values)) for name, values in lines if name not in ('max_evaluations', 'steps', 'samples')]

    def made_samples(self):
        if self.samples is None:
            self.run('render', 'seed.toml', '-m', 'path_tracer', '--samples', '0..64', '-o', 'seed.exr')
            self.samples = (self.folder / 'seed.exr.samples').read_bytes()
        return self.samples

    def made_project(self):
        """A project whose experiment was run: its journal, cache and records."""
        if self.journal is None:
            self.project('project', EXPERIMENT)
            self.run('experiment', 'run', 'g/e', '--root', 'project')
            self.journal = sorted(p for p in (self.folder / 'project' / 'results').rglob('*')
                                  if p.is_file() and 'images' not in p.parts and 'plots' not in p.parts and p.suffix != '.exr')
            self.originals = {p: p.read_bytes() for p in self.journal}
        return self.journal

    def project(self, name, experiment):
        self.write(f'{name}/experiments/README.md', '')
        self.write(f'{name}/experiments/scenes/one.toml', CAMERA + LIGHT + FOG)
        self.write(f'{name}/experiments/g/e.toml', experiment)


def exr(width, height, compression=0):
    """A small OpenEXR file of floats, written from its specification."""
    def attribute(name, kind, data):
        return name.encode() + b'\0' + kind.encode() + b'\0' + struct.pack('<i', len(data)) + data
    channels = b''.join(c + b'\0' + struct.pack('<iB3xii', 2, 0, 1, 1) for c in (b'B', b'G', b'R')) + b'\0'
    window = struct.pack('<4i', 0, 0, width - 1, height - 1)
    header = struct.pack('<ii', 20000630, 2) + attribute('channels', 'chlist', channels)
    header += attribute('compression', 'compression', bytes([compression])) + attribute('dataWindow', 'box2i', window)
    header += attribute('displayWindow', 'box2i', window) + attribute('lineOrder', 'lineOrder', b'\0')
    header += attribute('pixelAspectRatio', 'float', struct.pack('<f', 1)) + attribute('airlight.scene', 'string', b'one')
    header += attribute('screenWindowCenter', 'v2f', struct.pack('<2f', 0, 0))
    header += attribute('screenWindowWidth', 'float', struct.pack('<f', 1)) + b'\0'
    line, begin = 8 + 12 * width, len(header) + 8 * height
    body = b''.join(struct.pack('<Q', begin + y * line) for y in range(height))
    for y in range(height):
        body += struct.pack('<ii', y, 12 * width) + struct.pack(f'<{3 * width}f', *[0.5 + x for x in range(3 * width)])
    return header + body


def render(r, scene, methods=METHODS):
    method = r.choice(methods)
    arguments = ['render', scene, '-m', method, '-o', 'out.exr', '--threads', '1', '--override', 'film.width=2', '--override', 'film.height=2']
    for setting in SMALL[method] if r.random() < 0.95 or method != 'deterministic' else []:
        arguments += ['--set', setting]
    return arguments


def scene(r, box):
    text = mutate.text(r, CAMERA + ''.join(r.choice(box.scenes[3:]) for _ in range(r.choice((1, 2, 3)))) + r.choice((LIGHT, FOG, LIGHT + FOG)))
    box.write('scene.toml', text)
    return render(r, 'scene.toml') if r.random() < 0.7 else ['explain', 'scene.toml', '-m', r.choice(METHODS)]


def experiment(r, box):
    # A plot is drawn by gnuplot, which takes a hundred times as long as all the rest.
    text = mutate.text(r, EXPERIMENT + PLOT * (r.random() < 0.05))
    # Films, runs and samples may be any size that is asked for; what is asked for here stays small.
    text = re.sub(rb'\d{3,}(?![.eE\d])', lambda m: m.group()[:2], text)
    shutil.rmtree(box.folder / 'mutated', ignore_errors=True)
    box.project('mutated', text)
    return ['experiment', 'run', 'g/e', '--root', 'mutated', '--threads', '1']


def author(r, box):
    frames, script = FRAMES, SCRIPT
    which = r.random()
    if which < 0.3:
        frames = mutate.text(r, FRAMES)
    elif which < 0.6:
        lines = script.splitlines()
        at = r.randrange(len(lines))
        lines[at] = json.dumps(mutate.tree(r, json.loads(lines[at])))
        script = '\n'.join(lines) + '\n'
    else:
        script = mutate.text(r, SCRIPT)
    box.write('frames.csv', frames)
    box.write('script.jsonl', script)
    return ['author', 'script.jsonl', '-o', 'authored.toml']


SLOW = ('multiple_scattering_monte_carlo', 'slab_table', 'slab_orders', 'slab_exit_radiance', 'slab_point', 'halfspace', 'identity',
        'sphere_environment_all_orders', 'sphere_central_point', 'single_scattering_environment', 'march_single_scattering', 'ol_table',
        'multiple_scattering_sphere')


def shorter(r, value):
    """Lists and objects of many entries keep three of them: each entry may be a measurement."""
    if isinstance(value, dict):
        return {k: shorter(r, value[k]) for k in (r.sample(sorted(value), 3) if len(value) > 3 and is_number(min(value)) else value)}
    if isinstance(value, list) and len(value) > 3 and isinstance(value[0], list):
        return r.sample(value, 3)
    return value


def is_number(name):
    try:
        return float(name) == float(name)
    except ValueError:
        return False


def vectors_costly(r, box):
    """What is measured by Monte Carlo: whatever the numbers, it ends or is refused."""
    file = dict(box.vectors[0])
    vector = r.choice([v for v in file['vectors'] if v['kind'] in SLOW])
    vector = {k: shorter(r, v) for k, v in vector.items()}
    for key in r.choice((('input',), ('input',), ('expected',), ('input', 'input'), ('input', 'expected', 'accuracy'))):
        if key == 'expected' and r.random() < 0.3:  # albedos and cosines are names
            try:
                vector[key] = json.loads(mutate.number(r, json.dumps(vector[key])))
            except json.JSONDecodeError:
                pass
        elif vector[key]:
            vector[key] = mutate.tree(r, vector[key]) or {}
    file['vectors'] = [vector]
    box.write('vectors.json', json.dumps(file))
    return ['verify', 'vectors.json']


def vectors(r, box):
    file = dict(r.choice(box.vectors))
    chosen = [v for v in file['vectors'] if v['kind'] not in SLOW]
    file['vectors'] = r.sample(chosen, r.choice((1, 2, 3)))
    if 'count' in file:
        file['count'] = len(file['vectors'])
    if r.random() < 0.7:
        file['vectors'][0] = mutate.tree(r, file['vectors'][0])
        text = json.dumps(file)
    else:
        text = mutate.text(r, json.dumps(file, indent=1))
    box.write('vectors.json', text)
    return ['verify', 'vectors.json']


def csv(r, box):
    box.write('mutated.csv', mutate.text(r, CSV))
    box.write('csv.toml', CAMERA + LIGHT + '[[medium]]\ntype = "gaussians"\nfile = "mutated.csv"\n')
    return render(r, 'csv.toml')


def mesh_file(r, box, ending, content):
    box.write(f'mutated.{ending}', content)
    box.write(f'{ending}.toml', CAMERA + LIGHT + FOG + f'[[surface]]\ntype = "mesh"\nfile = "mutated.{ending}"\n')
    return render(r, f'{ending}.toml', ['deterministic', 'path_tracer', 'shadow_planes'])


def off(r, box):
    return mesh_file(r, box, 'off', mutate.text(r, OFF))


def obj(r, box):
    return mesh_file(r, box, 'obj', mutate.text(r, OBJ))


def ply(r, box):
    kind = r.choice(('ascii', 'binary_little_endian', 'binary_big_endian'))
    vertices, faces = VERTICES, list(FACES)
    if r.random() < 0.3:  # faces that have no area, polygons that cross themselves
        faces = [tuple(r.randrange(5) for _ in range(r.choice((3, 3, 4, 5, 7)))) for _ in range(5)]
    if kind == 'ascii':
        body = ''.join('{} {} {} 7\n'.format(*v) for v in vertices) + ''.join(f'{len(f)} {" ".join(map(str, f))}\n' for f in faces)
        content = mutate.text(r, PLY_HEAD.format(kind) + body)
    else:
        order = '<' if 'little' in kind else '>'
        body = b''.join(struct.pack(order + '3fB', *v, 7) for v in vertices)
        body += b''.join(struct.pack(f'{order}B{len(f)}i', len(f), *f) for f in faces)
        head = PLY_HEAD.format(kind).encode()
        content = mutate.binary(r, head + body) if r.random() < 0.6 else mutate.text(r, PLY_HEAD.format(kind)) + body
    return mesh_file(r, box, 'ply', content)


PLY_TYPES = {'char': 'b', 'uchar': 'B', 'int8': 'b', 'uint8': 'B', 'short': 'h', 'ushort': 'H', 'int': 'i', 'uint': 'I', 'int32': 'i',
             'uint32': 'I', 'float': 'f', 'double': 'd', 'float32': 'f', 'float64': 'd'}


def ply_value(r, kind, least, most):
    """A whole number from least to most, now and then one beyond, as far as the type holds it."""
    value = r.randint(least, max(least, most))
    if r.random() < 0.002:
        value = r.choice((-1, -2, most + 1, 127, 255, 32767, 65535, 2147483647, 4294967295, -2147483648))
    code = PLY_TYPES[kind]
    if code in 'fd':
        return float(value)
    bits = 8 * struct.calcsize(code)
    return max(0, min(value, (1 << bits) - 1)) if code.isupper() else max(-(1 << bits - 1), min(value, (1 << bits - 1) - 1))


def ply_number(r):
    """A coordinate: few different ones, so that points coincide and lie on lines; now and then an extreme one."""
    if r.random() < 0.003:
        return r.choice((1e30, -1e30, 3e38, 1e-30, 1e-45, -0.0, float('nan'), float('inf')))
    return r.choice((0, 0, 0, 1, 1, 2, 0.5, r.random()))


def ply_elements(r, box):
    """PLY whose header and body agree, whatever it announces: elements twice, empty ones, strips, other types, polygons without an area."""
    kind = r.choice(('ascii', 'binary_little_endian', 'binary_big_endian'))
    order = '>' if 'big' in kind else '<'
    whole = [t for t in PLY_TYPES if PLY_TYPES[t] not in 'fd']
    names = ['vertex', 'face']
    for _ in range(r.choice((0, 0, 0, 1, 1, 2))):
        names.insert(r.randrange(len(names) + 1), r.choice(('vertex', 'face', 'face', 'tristrips', 'edge', 'material', 'x', 'Vertex')))
    if r.random() < 0.05:
        r.shuffle(names)
    head, rows, vertices = [f'ply\nformat {kind} 1.0\n'], [], 0
    for name in names:
        count = r.choice((0, 1, 2, 3, 4, 5, 5, 5, 8, 30))
        if name == 'vertex':
            count = r.choice((1, 3, 4, 5, 5, 5, 9, 300))
            vertices = count if vertices == 0 else r.choice((vertices, count))
            properties = [(axis, None, r.choice(('float', 'float', 'double', 'float32', 'int', 'uchar'))) for axis in 'xyz']
            for _ in range(r.choice((0, 0, 1, 2))):
                properties.insert(r.randrange(len(properties) + 1), (r.choice(('nx', 'ny', 'nz', 'red', 's', 't', 'u', 'v', 'x', 'other')),
                                                                     None, r.choice(list(PLY_TYPES))))
        else:
            counting = r.choice(whole) if r.random() < 0.97 else 'float'
            corners = r.choice(('vertex_indices', 'vertex_indices', 'vertex_index', 'vertex_indexes')) if r.random() < 0.98 else 'other'
            properties = [(corners, counting, r.choice(whole) if r.random() < 0.97 else 'float')]
            for _ in range(r.choice((0, 0, 0, 1, 2))):
                properties.insert(r.randrange(2), (r.choice(('flags', 'red', 'texcoord', 'vertex_index', 'material_index')),
                                                   r.choice((None, r.choice(whole))), r.choice(list(PLY_TYPES))))
        if r.random() < 0.03:
            properties.pop(r.randrange(len(properties)))
        told = count if r.random() < 0.97 else r.choice((0, count + 1, -1, 2 ** 31, 2 ** 32 + count, 10 ** 18))
        head.append(f'element {name} {told}\n')
        for n, counting, value in properties:
            head.append(f'property list {counting} {value} {n}\n' if counting else f'property {value} {n}\n')
        for _ in range(count):
            row = []
            for n, counting, value in properties:
                if counting is None:
                    x = ply_number(r)
                    row.append((value, x if PLY_TYPES[value] in 'fd' else ply_value(r, value, 0, 3)))
                    continue
                length = r.choice((3, 3, 3, 3, 4, 4, 5, 6, 7, 20)) if r.random() < 0.995 else r.choice((0, 1, 2, 127, 255, 300))
                few = r.randint(1, max(1, vertices)) if r.random() < 0.3 else vertices
                list_of = [ply_value(r, value, 0, few - 1) for _ in range(length)]
                row += [(counting, ply_value(r, counting, length, length))] + [(value, x) for x in list_of]
            rows.append(row)
    head.append('end_header\n')
    if kind == 'ascii':
        body = ''.join(' '.join(str(x) for _, x in row) + '\n' for row in rows).encode()
    else:
        body = b''.join(struct.pack(order + PLY_TYPES[t], x) for row in rows for t, x in row)
    content = ''.join(head).encode() + body
    return mesh_file(r, box, 'ply', content if r.random() < 0.8 else mutate.binary(r, content))


def image(r, box):
    good = exr(r.choice((1, 4)), 2, r.choice((0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 200)))
    box.write('mutated.exr', mutate.binary(r, good, 330))
    which = r.random()
    if which < 0.3:
        return ['convert', 'mutated.exr', 'out.png']
    if which < 0.5:
        box.write('good.exr', exr(4, 2))
        return ['compare', *r.sample(['mutated.exr', 'good.exr'], 2)]
    box.write('environment.toml', CAMERA + FOG + '[[light]]\ntype = "environment"\nfile = "mutated.exr"\n')
    return render(r, 'environment.toml', ['deterministic', 'path_tracer', 'ray_marcher'])


def vdb(r, box):
    good = box.vdb[0]
    # Header, metadata and transform are the first 1200 bytes; the nodes' masks follow.
    box.write('mutated.vdb', mutate.binary(r, good, r.choice((1200, 1200, 40000))))
    box.write('vdb.toml', CAMERA + LIGHT + '[[medium]]\ntype = "grid"\nfile = "mutated.vdb"\n')
    return render(r, 'vdb.toml', ['deterministic', 'path_tracer', 'ray_marcher'])


def brdf(r, box):
    box.write('mutated.brdf', mutate.text(r, box.brdf))
    box.write('brdf.toml', CAMERA + LIGHT + '[[surface]]\ntype = "sphere"\ncenter = [0, 0, 0]\nradius = 1\n'
              'material = { type = "tabulated", file = "mutated.brdf" }\n')
    return render(r, 'brdf.toml', ['deterministic', 'path_tracer'])


def samples(r, box):
    box.write('mutated.samples', mutate.binary(r, box.made_samples(), 600))
    # Where the driver makes the checksum right again, the reader sees more than that it is wrong.
    return ['seal'] * (r.random() < 0.8) + ['merge', 'seed.toml', 'mutated.samples', '-o', 'out.exr']


def journal(r, box):
    files = box.made_project()
    for path, content in box.originals.items():  # a run replaces what it finds damaged
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)
    path = r.choice(files)
    content = box.originals[path]
    text = path.suffix in ('.json', '.csv', '.md', '.jsonl', '.journal')
    path.write_bytes(mutate.text(r, content.decode('utf-8', 'replace')) if text and r.random() < 0.7 else mutate.binary(r, content))
    command = r.choice((['experiment', 'run', 'g/e', '--resume'], ['gates', 'g/e', '--junit', 'junit.xml'], ['experiment', 'plot', 'g/e']))
    return ['seal'] * (r.random() < 0.8) + [*command, '--root', 'project']


def settings(r, box):
    method = r.choice(METHODS)
    arguments = render(r, 'seed.toml', [method])
    paths = ['medium.0.sigma_t', 'medium.0.region', 'medium.0.phase', 'light.0', 'light.*.intensity', 'camera.position.1', 'film', 'name',
             'surface.0', 'medium.*']
    for _ in range(r.choice((1, 1, 2, 3))):
        value = r.choice((r.choice(mutate.EXTREMES), r.choice(mutate.NASTY), str(r.randrange(1, 20)), '[1, 2, 3]', '{ type = "hg", g = 0.3 }',
                          '"' + r.choice(mutate.NASTY) + '"', '[' * 3000, 'a.' * 3000))
        if r.random() < 0.5:
            name, choices = r.choice(box.settings[method])
            flag, value = '--set', r.choice((value, *choices))
        else:
            flag, name = '--override', r.choice(paths)
        if r.random() < 0.2:
            name = mutate.text(r, name, (mutate.token, mutate.token)).decode('utf-8', 'replace')
        arguments += [flag, f'{name}={value}'.replace('\0', '')]
    if r.random() < 0.1:
        arguments[r.randrange(1, len(arguments))] = r.choice(mutate.NASTY).replace('\0', '')
    return arguments


ALL = {f.__name__: f for f in (scene, experiment, author, vectors, csv, off, obj, ply, ply_elements, image, vdb, brdf, samples, journal, settings)}
COSTLY = {f.__name__: f for f in (vectors_costly,)}  # left out unless they are named
