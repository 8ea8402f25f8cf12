#!/usr/bin/env python3
"""tests/tools/loop_counts.py OUT [--program FILE]: how often the loops of the GPU side go round, in the scenes of the papers'
tables of times, at 800 x 600.

Writes OUT/marked/SHADER, the shaders with every condition of a loop counted, renders the scenes with them (any driver, llvmpipe
too), and reads the counts from the picture: the pixels of a block of 8 x 4, what a warp is on a GPU, all show the same three loops'.
A hash of the block chooses them, so that the blocks of a loop lie all over the picture.
OUT/loops.csv: of each scene, shader and loop the mean by invocation, and that of the greatest in each block. OUT/dump/SCENE holds the
shaders, with `COUNT_TRIPS`, for scripts/frame_budgets."""
import argparse
import array
import csv
import os
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
WIDTH, HEIGHT, SCALE = 800, 600, 1024
FOGSHOP = [("fogshop/table1/" + name, name) for name in ("gargoyle", "box", "terrain", "city", "motorcycle")]
PLANES = [("shadow_planes/" + file, name) for file, name in
          (("fig8a", "pens"), ("fig8b", "media"), ("fig8c", "columns"), ("fig1", "nave"), ("fig7_shade", "Figure 7"))]
OPTIONS = {"fogshop_gpu": ["--set", "variant=paper", "--set", "reflectance=npsf"], "shadow_planes_gpu": [], "wavelet_fog_gpu": [],
           "compensated_ray_marching_gpu": ["--set", "variant=paper", "--set", "iterations=40"]}
SMOKE = [("compensated_ray_marching/plume_lobe", "fitted")] + [
    ("compensated_ray_marching/gaussians_lobe", f"{n} Gaussians", ["--override", f'medium.0.file="plume_{n}.csv"']) for n in (100, 400, 800)]
SPLINES = {"Haar": 0, "linear": 1, "quadratic": 2}


def wavelet_fog():
    """Tables 1 to 3 of Giroud and Biri 2010: scene, title and options of each entry."""
    def entry(table, spline, size, *settings):
        sets = [word for setting in settings for word in ("--set", setting.replace(" ", "="))]
        return ("wavelet_fog/table_%d" % size, " ".join([f"{table}: {spline} {size}", *settings[1:]]),
                ["--override", f"medium.0.degree={SPLINES[spline]}", *sets])
    return ([entry(1, spline, size, "variant direct") for spline in SPLINES for size in (16, 32, 64)] +
            [entry(2, "linear", 64, "variant paper", f"levels {levels}", f"mu {mu}")
             for levels in (1, 2, 3) for mu in ("1", "0.8", "0.6", "0.4", "0.2", "0")] +
            [entry(3, spline, size, "variant paper", f"levels {levels}", "mu 1")
             for spline, size in (("linear", 16), ("linear", 32), ("quadratic", 32)) for levels in (1, 2, 3)])


# Where a shader's counts go in the picture: statements replaced (by file), and the layer that then shows them.
SHOWN = {
    "raster/first_hits.comp": {"fogshop_gpu": "fogshop/surfaces.comp", "shadow_planes_gpu": "shadow_planes/shade.comp"},
    "fogshop/paper.comp": ("pixels[place_of(pixel)] = vec4(airlight * albedo, depth);",
                           "pixels[place_of(pixel)] = vec4(trips_shown(pixel), 0);", "airlight"),
    "fogshop/surfaces.comp": ("  if (loops_cut())",
                              "  for (int c = 0; c < 3; ++c) surface_layer[3 * place + c] = trips_shown(pixel)[c];\n"
                              "  if (loops_cut())", "surface"),
    "fogshop/tiles.comp": ("  list_gaussians(0);",
                           "  list_gaussians(0);\n  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy) + ivec2(0, tile_row * int(LOCAL_SIZE_Y));\n"
                           "  if (is_computed(pixel)) pixels[place_of(pixel)] = vec4(trips_shown(pixel), 0);", "airlight"),
    "fogshop/environment.comp": ("  pixels[index].rgb += max(sum * T * exp(-T), vec3(0));",
                                 "  pixels[index].rgb = trips_shown(pixel) + 0 * max(sum * T * exp(-T), vec3(0));",
                                 "airlight"),
    "shadow_planes/shade.comp": ("  lit_pixels[place] = lit;",
                                 "  lit.airlight.rgb += trips_shown(pixel);\n  lit_pixels[place] = lit;", "airlight"),
    "wavelet_fog/columns.comp": ("    depths[place] = part + 1 < parts ? vec4(before.rgb, sum) : vec4(before.rgb + depth_of(sum), 0);",
                                 "    depths[place] = vec4((part > 0 ? before.rgb : vec3(0)) + trips_shown(at), before.w * 0 + sum * 0);",
                                 "mean"),
    "compensated_ray_marching/ranges.comp": ("airlight[3 * place + c] = 0;", "airlight[3 * place + c] = trips_shown(at)[c];", "airlight"),
    "compensated_ray_marching/march.comp": ("airlight[3 * place + c] += light[c];", "airlight[3 * place + c] += trips_shown(at)[c];",
                                            "airlight"),
    "compensated_ray_marching/smoke_volume.comp": (
        "volume[at.x + size.x * (at.y + size.y * at.z)] = vec4(density * source, density);",
        "int warp = 2 * int(gl_WorkGroupID.x + gl_NumWorkGroups.x * (gl_WorkGroupID.y + gl_NumWorkGroups.y * gl_WorkGroupID.z)) + lane / 32;\n"
        "int block_shown = warp % BLOCKS;\n"
        "volume[at.x + size.x * (at.y + size.y * at.z)] =\n"
        "  vec4(trips_shown(ivec2(8 * (block_shown % BLOCKS_ALONG), 4 * (block_shown / BLOCKS_ALONG))), density + weight + sum.x);",
        "airlight"),
}
# What march.comp does instead where another shader's counts are shown: nothing, or it shows voxels, those of a warp in a block of pixels.
NO_MARCH = "  return;\n"
VOXELS_SHOWN = """  if (first_slice == 0 && at.x < width && at.y < height) {
    int block = at.y / 4 * BLOCKS_ALONG + at.x / 8, warp = block + BLOCKS * (block & 1), lane = at.y % 4 * 8 + at.x % 8 + 32 * (warp & 1);
    ivec3 size = ivec3(samples_along), groups = (size + 3) / 4;
    ivec3 v = 4 * (ivec3(warp / 2) / ivec3(1, groups.x, groups.x * groups.y) % ivec3(groups.x, groups.y, 1 << 30)) +
              ivec3(lane % 4, lane / 4 % 4, lane / 16);
    vec3 shown = all(lessThan(v, size)) ? volume[v.x + size.x * (v.y + size.y * v.z)].rgb : vec3(0);
    for (int c = 0; c < 3; ++c) airlight[3 * (at.y * width + at.x) + c] = shown[c];
  }
  return;
"""


def matching(text, at, brackets="()"):
    """Behind the bracket that closes the one before `at`."""
    depth = 1
    while depth:
        depth += {brackets[0]: 1, brackets[1]: -1}.get(text[at], 0)
        at += 1
    return at


def loops_counted(text, number):
    """The text with the condition of every loop counted; `number(text, at)` gives a place its number."""
    out, at = [], 0
    for match in re.finditer(r"\b(for|while) \(", text):
        begin, end = match.end(), matching(text, match.end()) - 1
        first, last = begin, end
        if match.group(1) == "for":
            first = text.index(";", begin) + 1
            last = text.index(";", first)
        condition = text[first:last].strip() or "true"
        out += [text[at:first], f" trip({number(text, match.start())}) && ({condition})"]
        at = last
    return "".join(out) + text[at:]


def branches_counted(text, number):
    """What runs behind `if (...) continue;` or `return`, within the braces of a condition, and behind them."""
    inserts = []
    for match in re.finditer(r"\bif \(", text):
        begin, end = match.end(), matching(text, match.end()) - 1
        behind = text[end + 1:]
        if re.match(r" (continue|return\b[^;]*);", behind):
            inserts += [(begin, "("), (end, f") || !trip({number(text, begin)})")]
        elif behind.startswith(" {"):
            inserts += [(begin, "("), (end, f") && trip({number(text, begin)})")]
            close = matching(text, end + 3, "{}")
            if text.startswith(" else {", close):
                inserts.append((close + 7, f" trip({number(text, close)});"))
                close = matching(text, close + 7, "{}")
            if not text.startswith(" else", close):
                inserts.append((close, f" trip({number(text, close)});"))
    for at, words in sorted(inserts, reverse=True, key=lambda i: i[0]):
        text = text[:at] + words + text[at:]
    return text


def marked(target):
    """All shaders by name, what runs in one of them counted; and the marked places, file:line."""
    loops, texts = [], {}
    for path in sorted((ROOT / "gpu").glob("**/*")):
        name = str(path.relative_to(ROOT / "gpu"))
        if path.suffix not in (".glsl", ".comp", ".vert", ".frag"):
            continue
        texts[name] = path.read_text()

    def reached(name, seen):
        if name not in seen:
            seen.add(name)
            for other in re.findall(r'^#include "(.*)"', texts[name], re.M):
                reached(other, seen)
        return seen
    for name in sorted(reached(target, set()) - {"common/loops_cut.glsl"}):
        def number(text, at, name=name):
            loops.append(f"{name}:{text.count(chr(10), 0, at) + 1}")
            return len(loops) - 1
        texts[name] = loops_counted(branches_counted(texts[name], number), number)
    definition = ("\n#define COUNT_TRIPS 1\n#if COUNT_TRIPS\nuint trips[%d];\nbool trip(int k) { ++trips[k]; return true; }\n"
                  "vec3 trips_shown(ivec2 pixel) {\n  vec3 sum = vec3(0);\n  for (int c = 0; c < 3; ++c) {\n"
                  "    uint k = (uint(pixel.x / 8) * 40503u + uint(pixel.y / 4) * 30011u + uint(c) * 20749u) * 2654435769u;\n"
                  "    k = (k ^ k >> 15) %% %du;\n    for (int i = 0; i < %d; ++i) if (i == int(k)) sum[c] = %d.0 * float(trips[i]);\n"
                  "  }\n  return sum;\n}\n#endif\n" % (len(loops), len(loops), len(loops), SCALE))
    for name, text in texts.items():
        if name.endswith(".comp"):
            added = definition if name == target else "#define trip(k) true\n"
            texts[name] = re.sub(r"(layout\(local_size_x[^;]*;\n)", lambda m: m.group(1) + added, text, count=1)
    zeroed = "void main() {\n#if COUNT_TRIPS\n  for (int i = 0; i < %d; ++i) trips[i] = 0u;\n#endif\n" % len(loops)
    texts[target] = texts[target].replace("void main() {\n", zeroed)
    return texts, loops


def shown(texts, target, method):
    """Has the counts of `target` shown in the picture; returns the layer."""
    if target == "raster/first_hits.comp":
        old = "if (keeps_primitives != 0) primitives[first_ray + place] = best.primitive;"
        new = "#if COUNT_TRIPS\n  primitives[first_ray + place] = int(trips_shown(at).x);\n#else\n  " + old + "\n#endif"
        texts[target] = replaced(texts[target], "  " + old, new)
        by = SHOWN[target][method]
        if method == "fogshop_gpu":
            main = ("void main() {\n  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);\n"
                    "  if (pixel.x >= view_width || pixel.y >= view_height) return;\n"
                    "  int place = pixel.y * view_width + pixel.x;\n"
                    "  for (int c = 0; c < 3; ++c) surface_layer[3 * place + c] = float(primitive_of[place]);\n}\n")
            texts[by] = texts[by][:texts[by].index("void main() {")] + main
            return "surface"
        texts[by] = replaced(texts[by], "int primitive = has_primitives != 0 ? primitive_of[place] : -1, surface = -1;",
                             "int shown = primitive_of[place], primitive = -1, surface = -1;")
        texts[by] = replaced(texts[by], "  lit_pixels[place] = lit;",
                             "  lit.airlight.rgb = vec3(float(shown));\n  lit_pixels[place] = lit;")
        return "airlight"
    if target == "wavelet_fog/columns.comp":
        texts["wavelet_fog/composition.comp"] = replaced(texts["wavelet_fog/composition.comp"],
                                                         "has_fog != 0 ? depths[place].rgb : vec3(0), behind);",
                                                         "vec3(0), depths[place].rgb);")
    if target in ("compensated_ray_marching/ranges.comp", "compensated_ray_marching/smoke_volume.comp"):
        main = "  ivec2 at = ivec2(gl_GlobalInvocationID.xy);\n  bool within_film"
        first = NO_MARCH if target.endswith("ranges.comp") else blocks_named(VOXELS_SHOWN)
        by = "compensated_ray_marching/march.comp"
        texts[by] = replaced(texts[by], main, main.replace("\n", "\n" + first))
    if target == "fogshop/tiles.comp":
        written = "if (visible) pixels[place_of(pixel)] = vec4(airlight * albedo, depth);"
        texts["fogshop/paper.comp"] = replaced(texts["fogshop/paper.comp"], written, written.replace("visible", "false"))
    old, new, layer = SHOWN[target]
    new = blocks_named(new)
    texts[target] = replaced(texts[target], old, "\n#if COUNT_TRIPS\n" + new + "\n#else\n" + old + "\n#endif\n")
    return layer


def blocks_named(text):
    """The text with the number of blocks of 8 x 4 pixels along the picture, and in it."""
    return text.replace("BLOCKS_ALONG", str(WIDTH // 8)).replace("BLOCKS", str(WIDTH // 8 * (HEIGHT // 4)))


def replaced(text, old, new):
    if text.count(old) != 1:
        sys.exit(f"loop_counts: the shaders no longer hold once: {old}")
    return text.replace(old, new)


def pictures(file):
    """A PFM file's channels: rows, top first."""
    data = file.read_bytes()
    head = data.split(b"\n", 3)
    width, height = map(int, head[1].split())
    values = array.array("f", head[3])
    channels = 3 if head[0] == b"PF" else 1
    return [[values[y * width * channels + c:(y + 1) * width * channels:channels] for y in reversed(range(height))]
            for c in range(channels)]


def loop_shown(x, y, channel, loops):
    """The loop that a channel of a block shows: trips_shown in the shaders."""
    k = (x // 8 * 40503 + y // 4 * 30011 + channel * 20749) * 2654435769 & 0xffffffff
    return (k ^ k >> 15) % loops


def counts(channels, loops):
    """By loop: mean of an invocation, mean of the greatest of a block."""
    sums, most, blocks = [0.0] * loops, [0.0] * loops, [0] * loops
    for channel, rows in enumerate(channels):
        for y in range(0, HEIGHT, 4):
            for x in range(0, WIDTH, 8):
                block = [round(v / SCALE) for row in rows[y:y + 4] for v in row[x:x + 8]]
                k = loop_shown(x, y, channel, loops)
                sums[k] += sum(block) / len(block)
                most[k] += max(block)
                blocks[k] += 1
    return [(sums[k] / blocks[k], most[k] / blocks[k]) for k in range(loops)]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--program", default=str(ROOT / "build" / "release" / "airlight"))
    parser.add_argument("--only", default="", help="a part of the scene's or shader's name")
    arguments = parser.parse_args()
    if not pathlib.Path(arguments.program).exists():
        sys.exit(f"loop_counts: there is no program at {arguments.program}; run scripts/build first")
    out = arguments.out.resolve()
    rows, failed = [], 0
    for method, scenes in (("fogshop_gpu", FOGSHOP), ("shadow_planes_gpu", PLANES), ("wavelet_fog_gpu", wavelet_fog()),
                           ("compensated_ray_marching_gpu", SMOKE)):
        targets = [name for name in SHOWN if name.startswith(method.removesuffix("_gpu")) or method in SHOWN[name]]
        for target in targets:
            texts, loops = marked(target)
            layer = shown(texts, target, method)
            folder = out / "marked" / method / target.replace("/", "-")
            for name, text in texts.items():
                (folder / name).parent.mkdir(parents=True, exist_ok=True)
                (folder / name).write_text(text)
            for scene, title, *options in scenes:
                if arguments.only not in title + " " + target:
                    continue
                if target == "fogshop/environment.comp" and title in ("gargoyle", "box"):  # lit by points
                    continue
                if target == "compensated_ray_marching/smoke_volume.comp" and title != "fitted":  # Gaussians alone have no voxels
                    continue
                image = out / f"{title}-{target.replace('/', '-')}.exr"
                environment = dict(os.environ, AIRLIGHT_SHADERS=str(folder), AIRLIGHT_DUMP_SHADERS=str(out / "dump" / title))
                (out / "dump" / title).mkdir(parents=True, exist_ok=True)
                command = [arguments.program, "render", str(ROOT / "experiments/scenes" / (scene + ".toml")), "-m", method,
                           *OPTIONS[method], *(options[0] if options else []), "--override", f"film.width={WIDTH}", "--override", f"film.height={HEIGHT}",
                           "-o", str(image)]
                result = subprocess.run(command, env=environment, capture_output=True, text=True)
                if result.returncode:
                    print(f"{title} {target}: exit code {result.returncode}: {result.stderr.strip()[-400:]}", file=sys.stderr)
                    failed += 1
                    continue
                plain = image.with_suffix(".pfm")
                subprocess.run([arguments.program, "convert", str(image), str(plain), "--layer", layer], check=True)
                channels = pictures(plain)  # where primitives are shown, all are alike
                found = counts(channels[:1] if target.startswith("raster/") else channels, len(loops))
                rows += [[title, target, k, place, f"{mean:.6g}", f"{most:.6g}"]
                         for k, (place, (mean, most)) in enumerate(zip(loops, found))]
                print(title, target, "done", flush=True)
                with open(out / "loops.csv", "w", newline="") as file:
                    csv.writer(file, lineterminator="\n").writerows([["scene", "shader", "loop", "place", "mean", "warp"], *rows])
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
