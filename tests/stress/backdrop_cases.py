"""Cases of bad_input.py: pictures with depth behind a medium, and particles in it."""
import struct
import zlib

OUT = ['-m', 'deterministic', '-o', 'never.exr']


def png(width, height, rows):
    """A PNG of 8-bit colours, of these bytes of pixels."""
    def chunk(kind, data):
        return struct.pack('>I', len(data)) + kind + data + struct.pack('>I', zlib.crc32(kind + data))
    lines = b''.join(b'\0' + rows[3 * width * y:3 * width * (y + 1)] for y in range(height))
    return (b'\x89PNG\r\n\x1a\n' + chunk(b'IHDR', struct.pack('>IIBBBBB', width, height, 8, 2, 0, 0, 0)) +
            chunk(b'IDAT', zlib.compress(lines)) + chunk(b'IEND', b''))


def queue(case, write, scene):
    """Pictures with depth, and particles, that are damaged, of another size, or without sense."""
    whole = png(2, 1, bytes(range(6)))
    pfm = b'Pf\n2 1\n-1\n' + struct.pack('<2f', 1, 2)
    write('picture.png', whole)
    write('depth.pfm', pfm)

    def backdrop(name, keys, **more):
        case(f'backdrop, {name}', ['render', write(f'backdrop {name}.toml', scene + f'[backdrop]\n{keys}\n'), *OUT], **more)

    good = 'image = "picture.png"\ndepth = "depth.pfm"'
    case('backdrop, good', ['render', write('backdrop.toml', scene + f'[backdrop]\n{good}\n'), *OUT[:2], '-o', 'backdrop.exr'], code=0,
         other_codes=(0,))
    for length in (0, 1, 7, 8, 20, 40, len(whole) - 20):
        backdrop(f'PNG of {length} bytes', good.replace('picture', write(f'cut{length}.png', whole[:length])[:-4]), says='cut')
    for at in (0, 16, 24, 45):
        damaged = whole[:at] + bytes([whole[at] ^ 0x55]) + whole[at + 1:]
        backdrop(f'PNG damaged at {at}', good.replace('picture', write(f'bad{at}.png', damaged)[:-4]), says='bad')
    for length in range(len(pfm)):
        backdrop(f'PFM of {length} bytes', good.replace('depth.pfm', write(f'cut{length}.pfm', pfm[:length])), says='cut')
    for what, text in {'minus': b'Pf\n-2 1\n-1\n', 'words': b'Pf\ntwo 1\n-1\n', 'nothing': b'Pf\n0 0\n-1\n', 'no order': b'Pf\n2 1\n0\n',
                       'other size': b'Pf\n1 2\n-1\n', 'huge': b'Pf\n2000000000 2000000000\n-1\n'}.items():
        backdrop(f'PFM, {what}', good.replace('depth.pfm', write(f'{what}.pfm', text + pfm[-8:])), says='.pfm' if what != 'other size' else '1 x 2')
    for what, values in {'NaN': (1, float('nan')), 'below 0': (1, -1), 'tiny': (1, 1e-30), 'far': (1, 3e38)}.items():
        backdrop(f'depth {what}', good.replace('depth.pfm', write(f'{what} depth.pfm', pfm[:-8] + struct.pack('<2f', *values))),
                 says='column 1, row 0: a depth of')
    backdrop('no image', 'depth = "depth.pfm"', says='image')
    backdrop('image missing', good.replace('picture', 'none'), says='none.png')
    backdrop('folder as image', good.replace('picture.png', 'sub'), says='sub')
    backdrop('unknown key', good + '\nimagge = 1', says='imagge')
    backdrop('scale of NaN', good + '\nscale = nan', says='scale')
    write('words.csv', 'set,x,y,z\n0,a,b,c\n')
    for what, keys in {'nothing': '', 'both': 'count = 3\nfile = "p.csv"', 'too many': 'count = 99999999', 'no file': 'file = "none.csv"',
                       'words': 'file = "words.csv"'}.items():
        text = scene + f'[[particles]]\ntype = "disc"\nradius = 1\nradiance = [[1, 1, 1]]\n{keys}\n'
        case(f'particles, {what}', ['render', write(f'particles {what}.toml', text), *OUT])
