"""Mutations of inputs: bytes, text tokens, structure. All take a random.Random, and nothing else is random."""
import re
import struct

EXTREMES = ['0', '-0', '1', '-1', '1e-300', '1e300', '-1e300', '5e-324', '1.7976931348623157e308', '1e309', 'nan', 'inf', '-inf', '1e-30',
            '1e30', '3.5e38', '1e-45', '2147483647', '2147483648', '-2147483649', '4294967296', '9223372036854775807',
            '9223372036854775808', '1e19', '0x10', '1_000', '.5', '5.', '--1', '1e', '00', 'true', '""']
NASTY = ['', '\x1b[31m', '\r', '\n', '\t', '\x00', '\x7f', '\u2028', '\u202e', '\ufeff', 'é', '\U0001f32b', '%s%n', '{}', '{0}', '../..', '/',
         '"', "'", '\\', ',', '.', '=', '[', ']', '{', '}', '#', '*', ' ', 'a' * 5000, '[' * 300, '{a=' * 100, 'a.' * 300, '\n' * 50]
NUMBER = re.compile(r'[-+]?\d+\.?\d*(?:[eE][-+]?\d+)?')
TOKEN = re.compile(r'"[^"\n]*"|[-+\w.]+|\s+|[^\w\s]')


def flip_bits(r, data):
    data = bytearray(data)
    for _ in range(r.choice((1, 1, 2, 4, 16))):
        if data:
            data[r.randrange(len(data))] ^= 1 << r.randrange(8)
    return bytes(data)


def set_bytes(r, data):
    data = bytearray(data)
    for _ in range(r.choice((1, 1, 2, 8))):
        if data:
            data[r.randrange(len(data))] = r.choice((0, 1, 0x7f, 0x80, 0xff, 0x0a, 0x20, r.randrange(256)))
    return bytes(data)


def truncate(r, data):
    return data[:r.randrange(len(data) + 1)]


def cut(r, data):
    begin = r.randrange(len(data) + 1)
    return data[:begin] + data[begin + r.choice((1, 2, 4, 16, 200)):]


def repeat(r, data):
    begin = r.randrange(len(data) + 1)
    piece = data[begin:begin + r.choice((1, 4, 16, 200, 2000))]
    return data[:begin] + piece * r.choice((2, 3, 50)) + data[begin:]


def splice(r, data):
    a, b = r.randrange(len(data) + 1), r.randrange(len(data) + 1)
    return data[:a] + data[b:b + r.choice((4, 40, 400, 4000))] + data[a:]


def set_word(r, data):
    """A whole number or a real one of four or eight bytes is replaced by one at its ends."""
    kind = r.choice('<i <I <q <Q <f <d >i >f >H'.split())
    size = struct.calcsize(kind)
    if len(data) < size:
        return data
    at = r.randrange(len(data) - size + 1)
    if kind[1] in 'fd':
        value = r.choice((0.0, -1.0, float('nan'), float('inf'), 1e-30, 3e38, 1e30, 1e-45, -0.0))
    else:
        bits = 8 * size
        most = (1 << bits - 1) - 1 if kind[1] in 'iq' else (1 << bits) - 1
        value = r.choice((0, 1, 2, 255, 65535, most, most - 1, most // 2, most // 8)) * (r.choice((1, -1)) if kind[1] in 'iq' else 1)
    try:
        return data[:at] + struct.pack(kind, value) + data[at + size:]
    except (struct.error, OverflowError):
        return data


BINARY = (flip_bits, flip_bits, set_bytes, set_word, set_word, truncate, cut, repeat, splice)


def binary(r, data, head=None):
    """One to three mutations; `head`: that many bytes at the beginning are met more often."""
    for _ in range(r.choice((1, 1, 1, 2, 3))):
        mutation = r.choice(BINARY)
        if head and len(data) > head and r.random() < 0.7:
            data = mutation(r, data[:head]) + data[head:]
        else:
            data = mutation(r, data)
    return data


def _replace(r, text, pattern, make):
    found = list(pattern.finditer(text))
    if not found:
        return text
    match = r.choice(found)
    return text[:match.start()] + make(match.group()) + text[match.end():]


def number(r, text):
    def make(old):
        kind = r.randrange(4)
        if kind == 0:
            return r.choice(EXTREMES)
        if kind == 1:
            return old + 'e' + str(r.randrange(-310, 310))
        if kind == 2:
            return '-' + old
        return str(r.choice((2, 10, 1000, 10 ** 6, 1e-3, 1e-9, 1e9)))
    return _replace(r, text, NUMBER, make)


def token(r, text):
    tokens = TOKEN.findall(text)
    if not tokens:
        return text
    at, other = r.randrange(len(tokens)), r.randrange(len(tokens))
    kind = r.randrange(5)
    if kind == 0:
        tokens[at] = ''
    elif kind == 1:
        tokens[at] *= r.choice((2, 2, 3, 40))
    elif kind == 2:
        tokens[at] = tokens[other]
    elif kind == 3:
        tokens[at], tokens[other] = tokens[other], tokens[at]
    else:
        tokens[at] = r.choice(NASTY)
    return ''.join(tokens)


def line(r, text):
    lines = text.splitlines(True)
    if not lines:
        return text
    at, kind = r.randrange(len(lines)), r.randrange(4)
    if kind == 0:
        del lines[at]
    elif kind == 1:
        lines[at] *= r.choice((2, 2, 100))
    elif kind == 2:
        lines.insert(at, r.choice(lines))
    else:
        lines[at] = lines[at].rstrip('\n') + r.choice((lines[r.randrange(len(lines))], '\r\n', ' '))
    return ''.join(lines)


def nest(r, text):
    """Deep nesting of lists, tables, keys, in place of a value or at the end."""
    depth = r.choice((20, 40, 200, 2000, 30000))
    value = r.choice(('[' * depth + ']' * depth, '[' * depth, '{a=' * depth + '1' + '}' * depth, '{"a":' * depth + '1' + '}' * depth,
                      '.'.join(['a'] * depth) + ' = 1\n', '[' + '.'.join('a' * depth) + ']\n', '"' * depth, '-' * depth, '[[' * depth,
                      'a' * depth))
    if r.random() < 0.5:
        return _replace(r, text, NUMBER, lambda _: value)
    return text + '\n' + value if r.random() < 0.5 else value + '\n' + text


def string(r, text):
    nasty = r.choice(NASTY)
    return _replace(r, text, re.compile(r'"[^"\n]*"'), lambda old: r.choice((f'"{nasty}"', old[:-1] + nasty + '"', f'"{ascii(nasty)[1:-1]}"')))


TEXT = (number, number, number, token, token, line, line, string, nest)
NUMBERS = (number,)


def text(r, source, kinds=TEXT):
    """One to four mutations of a text, now and then of its bytes as well, or of its ends of line and byte order mark. Every other one is
    of numbers alone: most of those can still be read, and go further."""
    if kinds is TEXT and r.random() < 0.5:
        kinds = NUMBERS
    for _ in range(r.choice((1, 1, 1, 2, 2, 4))):
        source = r.choice(kinds)(r, source)
    data = source.encode('utf-8', 'surrogatepass')
    kind = 1 if kinds is NUMBERS else r.random()
    if kind < 0.1:
        data = binary(r, data)
    elif kind < 0.13:
        data = data.replace(b'\n', b'\r\n')
    elif kind < 0.15:
        data = b'\xef\xbb\xbf' + data
    elif kind < 0.16:
        data = source.encode('utf-16', 'surrogatepass')
    return data


def tree(r, value):
    """One mutation somewhere in lists and objects of JSON."""
    if isinstance(value, dict) and value and r.random() < 0.8:
        key = r.choice(sorted(value))
        kind = r.random()
        value = dict(value)
        if kind < 0.12:
            del value[key]
        elif kind < 0.2:
            value[key + r.choice(('', 'x', '\n'))] = value[r.choice(sorted(value))]
        else:
            value[key] = tree(r, value[key])
        return value
    if isinstance(value, list) and value and r.random() < 0.8:
        at, kind = r.randrange(len(value)), r.random()
        value = list(value)
        if kind < 0.12:
            del value[at]
        elif kind < 0.25:
            value = value[:at] + [value[at]] * r.choice((2, 3, 100)) + value[at:]
        else:
            value[at] = tree(r, value[at])
        return value
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        return r.choice((0, -1, 1, value * 2, -value, value * 1e6, value * 1e-6, 1e300, -1e300, 1e-300, 5e-324, 2 ** 31, -2 ** 63, 10 ** 19,
                         2 ** 53, 0.5, 3, str(value), None, float('nan'), float('inf')))
    return r.choice((None, True, 0, -1, 1e300, '', 'x', 'inf', 'nan', '\x1b\n', [], {}, [[]], [1, 2, 3], {'a': 1}, value))
