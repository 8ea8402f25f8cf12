"""Further targets of fuzz.py: flows, their folders and those of fits, and what scenes show of them; names; links."""
import json
import os
import shutil
import struct
import zlib

import mutate
from targets import CAMERA, FOG, LIGHT, NASTY_NAMES, exr, render

FLOW = """name = "f"
[flow]
duration = 0.2
frame_rate = 10
box = { lo = [0, 0, 0], hi = [1, 1, 1] }
[fluid]
gravity = [0, -9.81, 0]
expansion = 0.0033
viscosity = 0.001
[sides]
top = { type = "open" }
[start]
velocity = { type = "swirl", speed = 0.1 }
blob = [ { center = [0.4, 0.5, 0.5], width = 0.4, density = 1, temperature = 9 } ]
[[source]]
region = { type = "sphere", center = [0.5, 0.3, 0.5], radius = 0.3 }
density_rate = 1
[[force]]
acceleration = [3, 5, -4]
region = { type = "sphere", center = [0.5, 0.5, 0.5], radius = 0.4 }
[[obstacle]]
type = "sphere"
center = [0.8, 0.8, 0.8]
radius = 0.2
[[particles]]
count = 3
seed = 4
"""
START = '[start]\nfile = "start.vdb"\ngrid = "density"\n'
BOX = 'sigma_t = 1\nlo = [0, 0, 0]\nhi = [1, 1, 1]\n'
TINY = ['--threads', '1', '--limit', '10s', '--override', 'flow.duration=0.1', '--override', 'flow.frame_rate=10']


def kept(box, name, make):
    """The files of a folder that `make` fills once, as they were then."""
    if name not in box.made:
        make()
        box.made[name] = {p.relative_to(box.folder / name): p.read_bytes() for p in (box.folder / name).rglob('*') if p.is_file()}
    return box.made[name]


def restored(box, name, make):
    files = kept(box, name, make)
    shutil.rmtree(box.folder / name, ignore_errors=True)
    for path, content in files.items():
        box.write(f'{name}/{path}', content)
    return sorted(files)


def frames(box):
    box.write('good_flow.toml', FLOW)
    box.run('simulate', 'good_flow.toml', '--set', 'n=4', '--out', 'frames')


def damage(r, box, folder, names):
    """One file of the folder changed, cut, exchanged, or replaced by something that is no file."""
    names = [n for n in names if (box.folder / folder / n).is_file()]
    name, other = r.choice(names), r.choice(names)
    path, content = box.folder / folder / name, box.made[folder][name]
    if path.is_symlink():
        return None
    kind = r.choice(('bytes', 'bytes', 'bytes', 'text', 'gone', 'other', 'empty', 'folder', 'pipe', 'link'))
    if kind == 'bytes':
        return path.write_bytes(mutate.binary(r, content, 200))
    if kind == 'text':
        return path.write_bytes(mutate.text(r, content[:4000].decode('latin-1')) + content[4000:])
    if kind in ('other', 'empty'):
        return path.write_bytes(box.made[folder][other] if kind == 'other' else b'')
    path.unlink()
    if kind == 'gone':
        return None
    if kind == 'folder':
        path.mkdir()
    elif kind == 'pipe':
        os.mkfifo(path)
    elif kind == 'link':
        path.symlink_to(r.choice(('/dev/zero', '../victim', 'nowhere', '.')))
    return None


def flow(r, box):
    text = FLOW.replace('[[obstacle]]', '[[density]]\nname = "red"\n[[obstacle]]') if r.random() < 0.2 else FLOW
    method = r.choice(('stable_fluids', 'stable_fluids', 'legendre_fluids'))
    if method == 'legendre_fluids':
        text = text[:text.index('[sides]')] + text[text.index('[start]'):text.index('[[obstacle]]')] + text[text.index('[[particles]]'):]
    if r.random() < 0.2:
        restored(box, 'frames', lambda: frames(box))
        box.write('start.vdb', mutate.binary(r, (box.folder / 'frames/f.0001.vdb').read_bytes(), 1200))
        text = text[:text.index('[start]')] + START
    box.write('flow.toml', mutate.text(r, text))
    shutil.rmtree(box.folder / 'flown', ignore_errors=True)
    return ['simulate', 'flow.toml', '-m', method, '--set', 'n=4', '--out', 'flown', *TINY]


def flow_folder(r, box):
    names = restored(box, 'frames', lambda: frames(box))
    for _ in range(r.choice((0, 1, 1, 1, 2))):
        damage(r, box, 'frames', names)
    # Where the driver makes the state's checksum right again, the reader sees more than that it is wrong.
    seal = ['seal'] * (r.random() < 0.5)
    return [*seal, 'simulate', 'good_flow.toml', '--set', 'n=4', '--out', 'frames', '--threads', '1', '--limit', '10s']


def fits(box):
    restored(box, 'frames', lambda: frames(box))
    box.run('fit', 'frames/f.0001.vdb', 'frames/f.0002.vdb', '-n', '3', '--out', 'fits')


def fit(r, box):
    restored(box, 'frames', lambda: frames(box))
    box.write('smoke.vdb', mutate.binary(r, (box.folder / 'frames/f.0001.vdb').read_bytes(), r.choice((1200, 40000))))
    shutil.rmtree(box.folder / 'fitted', ignore_errors=True)
    return ['fit', 'smoke.vdb', '-n', '3', '--out', 'fitted', '--threads', '1', '--limit', '10s']


def fit_folder(r, box):
    names = restored(box, 'fits', lambda: fits(box))
    restored(box, 'frames', lambda: frames(box))
    for _ in range(r.choice((0, 1, 1, 1, 2))):
        damage(r, box, 'fits', names)
    return ['fit', 'frames/f.0001.vdb', 'frames/f.0002.vdb', '-n', '3', '--out', 'fits', '--threads', '1', '--limit', '10s']


def residual(r, box):
    restored(box, 'fits', lambda: fits(box))
    csv, rest = ((box.folder / f'fits/f.0001.{kind}').read_bytes() for kind in ('csv', 'residual'))
    which = r.random()
    if which < 0.75:
        rest = mutate.binary(r, rest, 120)
    elif which < 0.9:  # the others as they were: each belongs to the other
        csv = mutate.text(r, csv.decode())
    box.write('a.csv', csv)
    box.write('a.residual', rest)
    box.write('fitted.toml', CAMERA + LIGHT + '[[medium]]\ntype = "fitted"\ngaussians = "a.csv"\nresidual = "a.residual"\n')
    return ['seal'] * (r.random() < 0.8) + render(r, 'fitted.toml', ['deterministic', 'ray_marcher'])


def png(r, channels):
    """A small PNG written from its specification; half of them with mutations below checksums and compression, the others of the bytes."""
    deep = mutate.binary if r.random() < 0.5 else lambda r, data: data

    def chunk(kind, data):
        return struct.pack('>I', len(data)) + kind + data + struct.pack('>I', zlib.crc32(kind + data))
    bits = r.choice((8, 16)) if channels == 1 else 8
    row = b'\0' + bytes(i * 37 % 256 for i in range(4 * channels * bits // 8))
    head = struct.pack('>IIBBBBB', 4, 3, bits, 2 if channels == 3 else 0, 0, 0, 0)
    head = deep(r, head) if r.random() < 0.3 else head
    body = zlib.compress(deep(r, row * 3))
    content = b'\x89PNG\r\n\x1a\n' + chunk(b'IHDR', head) + chunk(b'IDAT', body) + chunk(b'IEND', b'')
    return content if deep is mutate.binary else mutate.binary(r, content)


def pfm(width, height):
    values = [0.5 + i % 7 for i in range(width * height)]
    return f'Pf\n{width} {height}\n-1.0\n'.encode() + struct.pack(f'<{len(values)}f', *values)


def picture(r, channels, kinds):
    """Its ending and its bytes, mutated."""
    kind = r.choice(kinds)
    if kind == 'png':
        return kind, png(r, channels)
    return kind, mutate.binary(r, pfm(4, 3) if kind == 'pfm' else exr(4, 3), 330)


def fogmap(r, box):
    kind, content = picture(r, 1, ('png', 'png', 'exr'))
    box.write(f'map.{kind}', content)
    box.write('fogmap.toml', CAMERA + LIGHT + f'[[medium]]\ntype = "fogmap"\nfile = "map.{kind}"\ncell = 1\ncorner = [-2, -1]\n'
              'region = { type = "slab", lo = -1, hi = 1 }\n' + ('channel = "R"\n' if kind == 'exr' else ''))
    return render(r, 'fogmap.toml', ['deterministic', 'ray_marcher'])


def backdrop(r, box):
    files = {'image': ('exr', exr(4, 3)), 'depth': ('pfm', pfm(4, 3))}
    which = r.choice(('image', 'depth'))
    files[which] = picture(r, 3, ('png', 'exr')) if which == 'image' else picture(r, 1, ('png', 'pfm', 'exr'))
    text = CAMERA + LIGHT + FOG + '[backdrop]\n'
    for key, (kind, content) in files.items():
        box.write(f'{key}.{kind}', content)
        text += f'{key} = "{key}.{kind}"\n'
    box.write('backdrop.toml', text + ('channel = "R"\n' if files['depth'][0] == 'exr' else ''))
    return render(r, 'backdrop.toml', ['deterministic', 'path_tracer', 'ray_marcher'])


def tables(r, box):
    """Where particles are, and the coefficients of a Legendre box."""
    if r.random() < 0.5:
        box.write('p.csv', mutate.text(r, 'set,x,y,z\n# a comment\n0,0,0,0\n0,0.5,0.1,-0.2\n1,0.5,0.5,0.5\n'))
        box.write('p.toml', CAMERA + LIGHT + FOG + '[[particles]]\ntype = "disc"\nfile = "p.csv"\nradius = 0.1\nradiance = [[1, 1, 1]]\n')
        return render(r, 'p.toml', ['deterministic', 'ray_marcher'])
    box.write('l.csv', mutate.text(r, 'i,j,k,coefficient\n0,0,0,1\n1,0,0,0.2\n0,1,1,-0.3\n'))
    box.write('l.toml', CAMERA + LIGHT + f'[[medium]]\ntype = "legendre"\nfile = "l.csv"\nsize = [2, 2, 2]\n{BOX}')
    return render(r, 'l.toml', ['deterministic', 'ray_marcher'])


def names(r, box):
    """A name of something that becomes the name of a file, or a part of one."""
    name = ''.join(r.choice((r.choice(NASTY_NAMES), r.choice(mutate.NASTY), 'a')) for _ in range(r.choice((1, 1, 2))))[:r.choice((20, 300))]
    text = json.dumps(name)
    kind = r.choice(('flow', 'density', 'author', 'map', 'scene', 'out'))
    shutil.rmtree(box.folder / 'named', ignore_errors=True)
    (box.folder / 'named').mkdir()
    if kind in ('flow', 'density'):
        flow = FLOW.replace('"f"', text) if kind == 'flow' else FLOW + f'[[density]]\nname = {text}\n'
        box.write('named.toml', flow)
        return ['simulate', 'named.toml', '--set', 'n=4', '--out', 'named/out', *TINY]
    file = 'named/' + name.replace('\0', '').replace('/', '_')[:200].encode('utf-8', 'replace')[:200].decode('utf-8', 'ignore')
    if kind == 'author':
        box.write('named.jsonl', '{"op": "scene", "base": "base.toml"}\n{"op": "paint", "stroke": [[0, 0, 0]], "a": 2, "c": 1}\n')
        return ['author', 'named.jsonl', '-o', file + '.toml']
    if kind == 'map':
        box.write('named.jsonl', '{"op": "fogmap", "width": 2, "height": 2}\n{"op": "view", "position": [0, 0, 5], "look_at": [0, 0, 0]}\n')
        return ['author', 'named.jsonl', '-o', file + '.toml']
    if kind == 'scene':
        box.write('named.toml', f'name = {text}\n' + CAMERA + LIGHT + FOG.replace('type', f'name = {text}\ntype', 1))
        return render(r, 'named.toml')
    return ['render', 'seed.toml', '-m', 'ray_marcher', '--override', 'film.width=2', '--override', 'film.height=2', '-o', file + '.exr']


def links(r, box):
    """Links to a file of somebody else's, where the program writes: fuzz.py looks whether that file stays as it was."""
    shutil.rmtree(box.folder / 'linked', ignore_errors=True)
    (box.folder / 'linked').mkdir()
    for name in r.sample(('f.0000.vdb', 'f.0001.vdb', 'f.particles.0000.csv', 'history.csv', 'state', 'a.exr', 'a.png', 'a.toml', 'a.csv',
                          'f.0001.csv', 'f.0001.residual', 'record.json', 'kept'), r.choice((1, 4, 13))):
        (box.folder / 'linked' / name).symlink_to('../victim')
    restored(box, 'frames', lambda: frames(box))
    box.write('named.jsonl', '{"op": "scene", "base": "base.toml"}\n{"op": "paint", "stroke": [[0, 0, 0]], "a": 2, "c": 1}\n')
    return r.choice((['simulate', 'good_flow.toml', '--set', 'n=4', '--out', 'linked', *TINY],
                     ['fit', 'frames/f.0001.vdb', '-n', '2', '--out', 'linked', '--threads', '1'],
                     ['author', 'named.jsonl', '-o', 'linked/a.toml'], ['convert', 'data/courtyard.exr', 'linked/a.png'],
                     [*render(r, 'seed.toml', ['path_tracer'])[:-2], '--samples', '64', '--cache', 'linked/kept'],
                     ['render', 'seed.toml', '-m', 'ray_marcher', '--override', 'film.width=2', '--override', 'film.height=2', '-o',
                      'linked/a.exr', '--png', 'linked/a.png']))


ALL = {f.__name__: f for f in (flow, flow_folder, fit, fit_folder, residual, fogmap, backdrop, tables, names, links)}
