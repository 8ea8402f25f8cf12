"""Draws a picture of the gallery: panels, labels, error maps and their scale, by gnuplot; and texts in PNG files."""
import array
import struct
import subprocess
import textwrap
import zlib

# Colours of the error maps at equal distances, as in experiments/judging/error_map.cpp.
VIRIDIS = [(68, 1, 84), (71, 44, 122), (59, 81, 139), (44, 113, 142), (33, 144, 141), (39, 173, 129), (92, 200, 99), (170, 220, 50),
           (253, 231, 37)]


def chunks(png):
    """Type and content of each chunk."""
    at = 8
    while at < len(png):
        size = struct.unpack(">I", png[at:at + 4])[0]
        yield png[at + 4:at + 8], png[at + 8:at + 8 + size]
        at += size + 12


def chunk(kind, content):
    return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))


def with_texts(png, texts):
    """The PNG with these texts behind its header, in place of any that were there."""
    kept = [(kind, content) for kind, content in chunks(png) if kind != b"tEXt"]
    kept[1:1] = [(b"tEXt", name + b"\0" + text) for name, text in texts.items()]
    return png[:8] + b"".join(chunk(kind, content) for kind, content in kept)


def read_pfm(path):
    with open(path, "rb") as stream:
        stream.readline()
        width, height = map(int, stream.readline().split())
        stream.readline()
        values = array.array("f", stream.read())
    return width, height, values


SRGB = bytes(round(255 * (12.92 * v if v <= 0.0031308 else 1.055 * v ** (1 / 2.4) - 0.055)) for v in (i / 65535 for i in range(65536)))


def shown(pfm, shrink, exposure):
    """8-bit sRGB of the panel, row 0 at the bottom: means over shrink x shrink pixels, times 2^exposure."""
    width, height, values = read_pfm(pfm)
    scale, pixels, row = 65535 * 2.0**exposure / shrink**2, bytearray(), 3 * width
    for y in range(0, height, shrink):
        line = [sum(column) for column in zip(*(values[(y + i) * row:(y + i + 1) * row] for i in range(shrink)))]
        colours = bytearray(row // shrink)
        for c in range(3):
            sums = (sum(part) for part in zip(*(line[3 * i + c::3 * shrink] for i in range(shrink))))
            colours[c::3] = bytes(SRGB[int(min(max(v * scale, 0.0), 65535.0) + 0.5)] for v in sums)
        pixels += colours
    return bytes(pixels)


def quoted(text):
    return text.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n")


def ramp(width, height):
    """Pixels of the scale bar: viridis from left to right."""
    row = bytearray()
    for x in range(width):
        at = x / (width - 1) * (len(VIRIDIS) - 1)
        i = min(int(at), len(VIRIDIS) - 2)
        row += bytes(round(a + (b - a) * (at - i)) for a, b in zip(VIRIDIS[i], VIRIDIS[i + 1]))
    return bytes(row) * height


class Canvas:
    """Commands for gnuplot that draw images and texts at pixels, from the left and from the top."""

    def __init__(self, width, height, out, folder):
        self.width, self.height, self.folder, self.labels = width, height, folder, 0
        self.lines = [f'set terminal pngcairo size {width},{height} font "Sans,11" background "#ffffff"', f'set output "{out}"',
                      "set multiplot", "unset key", "unset tics", "unset border", "unset colorbox"]

    def text(self, x, y, text, size=11, colour="#000000", align="left"):
        self.labels += 1
        self.lines.append(f'set label {self.labels} "{quoted(text)}" at screen {x / self.width},{1 - y / self.height} {align} noenhanced '
                          f'font "Sans,{size}" tc rgb "{colour}"')

    def image(self, left, top, w, h, source):
        """An image of w x h pixels: a PNG file, or the bytes of its pixels, row 0 at the bottom. It draws the texts before it, too."""
        if isinstance(source, bytes):
            file = f"{self.folder}/image{len(self.lines)}.rgb"
            with open(file, "wb") as stream:
                stream.write(source)
            data = f'"{file}" binary array=({w},{h}) format="%uchar%uchar%uchar"'
        else:
            data = f'"{source}" binary filetype=png'
        self.lines += [f"set lmargin at screen {left / self.width}", f"set rmargin at screen {(left + w) / self.width}",
                       f"set tmargin at screen {1 - top / self.height}", f"set bmargin at screen {1 - (top + h) / self.height}",
                       f"plot [-0.5:{w - 0.5}] [-0.5:{h - 0.5}] {data} using 1:2:3 with rgbimage", "unset label"]
        self.labels = 0

    def draw(self):
        subprocess.run(["gnuplot"], input="\n".join(self.lines) + "\n", text=True, check=True)


SCALE_HEIGHT = 80  # pixels below the line "error map"


def draw_scale(canvas, left, top, width, map_top):
    """The scale of the error maps, in the space below a reference."""
    canvas.text(left + 2, top + 24, "Error maps below the methods: difference in luminance from the\n"
                                    "reference, divided by the reference's mean luminance", 10, "#444444")
    for share, align in ((0, "left"), (0.5, "center"), (1, "right")):
        text = f"{100 * share * map_top:g} %" + (" and more" if share == 1 else "")
        canvas.text(left + 2 + share * (width - 4), top + 86, text, 10, "#444444", align)
    canvas.image(left + 2, top + 58, width - 4, 16, ramp(width - 4, 16))


GAP, HEAD = 4, 44  # pixels between panels, and of the labels over one


def caption_lines(picture, note, width):
    return [line for text in (picture["caption"], note) for line in textwrap.wrap(text, width // 8)]


def top_of(caption):
    """Where the first row begins [pixels from the top]."""
    return 32 + 19 * len(caption)


def strip_at(picture, columns, note):
    """Left and top pixel of the panels of a picture that has one row."""
    return GAP, top_of(caption_lines(picture, note, columns * (picture["width"] + GAP) + GAP)) + HEAD


def side_by_side(panels, width):
    """Rows of pixels from the top, of panels whose row 0 is at the bottom, with white between the panels."""
    size = 3 * width
    starts = range(len(panels[0]) - size, -1, -size)
    return [(b"\xff" * 3 * GAP).join(panel[at:at + size] for panel in panels) for at in starts]


def compressed(rows):
    """Data of a PNG image of 8-bit RGB: each row less the pixel to the left or the row above, whichever leaves the smaller numbers."""
    data, above = bytearray(), bytes(len(rows[0]))
    for row in rows:
        left = bytes(3) + row[:-3]
        filtered = [bytes((a - b) & 255 for a, b in zip(row, other)) for other in (left, above)]
        sums = [sum(min(v, 256 - v) for v in values) for values in filtered]
        best = sums.index(min(sums))
        data += bytes([1 + best]) + filtered[best]
        above = row
    return zlib.compress(bytes(data), 9)


def decompressed(png):
    """Rows of pixels of a PNG image of 8-bit RGB that is not interlaced."""
    parts = list(chunks(png))
    width, height, *kind = struct.unpack(">IIBBBBB", parts[0][1])
    if kind != [8, 2, 0, 0, 0]:
        raise ValueError(f"a PNG image of kind {kind}, expected 8-bit RGB")
    data = zlib.decompress(b"".join(content for name, content in parts if name == b"IDAT"))
    size, rows, above = 3 * width, [], bytearray(3 * width)
    for y in range(height):
        method, row = data[y * (size + 1)], bytearray(data[y * (size + 1) + 1:(y + 1) * (size + 1)])
        for i in range(size if method else 0):
            left, up, corner = (row[i - 3], above[i], above[i - 3]) if i > 2 else (0, above[i], 0)
            if method == 1:
                by = left
            elif method == 2:
                by = up
            elif method == 3:
                by = (left + up) // 2
            else:
                to = left + up - corner
                by = min((left, up, corner), key=lambda v: abs(to - v))
            row[i] = (row[i] + by) & 255
        rows.append(bytes(row))
        above = row
    return rows


STEPS = (2, 4, 6, 8)  # of 255, between the values that a picture keeps


def with_pixels(png, rows):
    out = png[:8]
    for name, content in chunks(png):
        out += b"" if name == b"IDAT" else (chunk(b"IDAT", compressed(rows)) if name == b"IEND" else b"") + chunk(name, content)
    return out


def no_larger_than(png, most):
    """The PNG with as many bytes at the most: values are rounded to the smallest of STEPS that does it. White stays white."""
    if len(png) <= most:
        return png
    rows = decompressed(png)
    for step in STEPS:
        table = bytes(min(255, (v + step // 2) // step * step) if v < 255 else 255 for v in range(256))
        out = with_pixels(png, [row.translate(table) for row in rows])
        if len(out) <= most:
            return out
    raise ValueError(f"the picture has {len(out)} bytes with steps of {STEPS[-1]}, expected at most {most}: split it")


def pixels_of(row):
    return [row[i:i + 3] for i in range(0, len(row), 3)]


NEAR = 2  # of 255: a pixel of a film that changes by no more stays as it is


def is_near(a, b):
    return a == b or max(abs(p - q) for p, q in zip(a, b)) <= NEAR


def animated(png, strips, at, rate):
    """A looping film (APNG): the PNG is its first frame, which shows the first strip at the pixel `at`; the later strips replace it. Pixels
    that stay as they are have a colour of their own, which is transparent and needs little space."""
    width, height = struct.unpack(">II", png[16:24])
    canvas, left = decompressed(png), 3 * at[0]
    for y, row in enumerate(strips[0], at[1]):  # gnuplot blends the last pixels of a panel with what lies beside it
        canvas[y] = canvas[y][:left] + row + canvas[y][left + len(row):]
    png = with_pixels(png, canvas)
    colours = {pixel for rows in strips for row in rows for pixel in pixels_of(row)}
    kept = next(c for c in (bytes([255, green, 255]) for green in range(256)) if c not in colours)
    shows, changes = [pixels_of(row) for row in strips[0]], []
    for strip in strips[1:]:
        rows = [[kept if is_near(new, old) else new for new, old in zip(pixels_of(row), before)] for row, before in zip(strip, shows)]
        shows = [[old if new == kept else new for new, old in zip(row, before)] for row, before in zip(rows, shows)]
        changes.append([b"".join(row) for row in rows])
    out, number = png[:8], 0

    def control(w, h, x, y):
        nonlocal number
        number += 1
        return chunk(b"fcTL", struct.pack(">IIIIIHHBB", number - 1, w, h, x, y, round(1000 / rate), 1000, 0, 1))

    for kind, content in chunks(png):
        if kind == b"IDAT" and not number:
            out += chunk(b"tRNS", struct.pack(">3H", *kept)) + chunk(b"acTL", struct.pack(">II", len(strips), 0))
            out += control(width, height, 0, 0)
        if kind == b"IEND":
            for rows in changes:
                out += control(len(rows[0]) // 3, len(rows), *at) + chunk(b"fdAT", struct.pack(">I", number) + compressed(rows))
                number += 1
        out += chunk(kind, content)
    return out


def compose(picture, panels, columns, note, out, folder):
    """The panels in rows, labels over them, maps of their errors below, by gnuplot."""
    w, h, gap, head, map_head = picture["width"], picture["height"], GAP, HEAD, 24
    width = columns * (w + gap) + gap
    caption = caption_lines(picture, note, width)
    rows = [panels[i:i + columns] for i in range(0, len(panels), columns)]
    tops, height = [], top_of(caption)
    for row in rows:
        tops.append(height)
        height += head + h + (map_head + max(h, SCALE_HEIGHT) if any(p["map"] for p in row) else 0)
    canvas = Canvas(width, height + gap, out, folder)
    canvas.text(gap + 2, 16, picture["title"], 13)
    for i, line in enumerate(caption):
        canvas.text(gap + 2, 40 + 19 * i, line, 11, "#444444")
    for row, top in zip(rows, tops):
        for i, panel in enumerate(row):
            left = gap + i * (w + gap)
            canvas.text(left + 2, top + 14, panel["label"])
            canvas.text(left + 2, top + 32, panel["second"], 10, "#444444")
            canvas.image(left, top + head, w, h, panel["pixels"])
            if panel["map"]:
                canvas.text(left + 2, top + head + h + 13, "error map", 10, "#444444")
                canvas.image(left, top + head + h + map_head, w, h, panel["map"])
            elif panel["scale"] and any(p["map"] for p in row):
                draw_scale(canvas, left, top + head + h, w, panel["scale"])
    canvas.draw()
