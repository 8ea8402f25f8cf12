#!/usr/bin/env python3
"""tests/tools/poison_shaders.py OUT: the shaders of gpu/, with every variable that is declared without a value set to poison.

    tests/tools/poison_shaders.py build/poisoned
    AIRLIGHT_SHADERS=build/poisoned AIRLIGHT_GPU_POISON=1 build/release/tests/airlight_tests "[gpu]"

Poison is NaN, or an index far below any array: who reads what no path has set shows it. Local and global variables, arrays too;
members of structures are left to scripts/check_shaders. AIRLIGHT_GPU_POISON does the same to buffers that a frame takes over."""
import pathlib
import re
import sys

POISON = {"float": "{t}(intBitsToFloat(-1))", "int": "{t}(-77777777)", "uint": "{t}(4000000000u)", "bool": "{t}(true)"}
KINDS = {"float": "float", "double": "float", "vec": "float", "dvec": "float", "mat": "float", "int": "int", "ivec": "int",
         "uint": "uint", "uvec": "uint", "bool": "bool", "bvec": "bool"}
DECLARATION = re.compile(r"^(\s*)((?:float|double|int|uint|bool|[diub]?vec[234]|mat[234]))\s+([^;]*);\s*(//.*)?$")


def pieces(text):
    """Parts between the commas that no bracket holds."""
    parts, depth = [""], 0
    for c in text:
        depth += (c in "([{") - (c in ")]}")
        if c == "," and depth == 0:
            parts.append("")
        else:
            parts[-1] += c
    return [part.strip() for part in parts]


def poisoned_line(line, is_global, arrays):
    found = DECLARATION.match(line)
    if not found:
        return [line]
    space, kind, names, _ = found.groups()
    poison = POISON[KINDS[re.sub(r"[234]$", "", kind)]].format(t=kind)
    values, loops = [], []
    for name in pieces(names):
        array = re.fullmatch(r"(\w+)\s*\[.*\]", name)
        if array and is_global:
            arrays.append((array.group(1), poison))
            loops.append(f"#define POISONED_{array.group(1)}")
        elif array:
            n = array.group(1)
            loops.append(f"{space}for (int poison_at = 0; poison_at < {n}.length(); ++poison_at) {n}[poison_at] = {poison};")
        elif re.fullmatch(r"\w+", name):
            name += f" = {poison}"
        values.append(name)
    return [f"{space}{kind} {', '.join(values)};", *loops]


def poisoned(text, arrays):
    out, depth, members = [], 0, []
    for line in text.split("\n"):
        code = line.split("//")[0]
        if members or line.startswith("#") or line.rstrip().endswith("\\"):
            out.append(line)
        else:
            out += poisoned_line(line, depth == 0, arrays)
        for c in code:
            if c == "{":
                depth += 1
                if re.match(r"\s*(struct\b|layout\s*\(.*\b(buffer|uniform)\b|(buffer|uniform)\b)", code):
                    members.append(depth)
            elif c == "}":
                if members and members[-1] == depth:
                    members.pop()
                depth -= 1
    return "\n".join(out)


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    root, out = pathlib.Path(__file__).resolve().parents[2] / "gpu", pathlib.Path(sys.argv[1])
    arrays, texts = [], {}
    for file in sorted(root.rglob("*")):
        if file.suffix in (".comp", ".vert", ".frag", ".glsl"):
            texts[file.relative_to(root)] = poisoned(file.read_text(), arrays)
    loops = "".join(f"#ifdef POISONED_{n}\n  for (int poison_at = 0; poison_at < {n}.length(); ++poison_at) {n}[poison_at] = {value};\n"
                    "#endif\n" for n, value in sorted(set(arrays)))
    for name, text in texts.items():
        (out / name).parent.mkdir(parents=True, exist_ok=True)
        (out / name).write_text(re.sub(r"^void main\(\) \{\n", lambda main: main.group(0) + loops, text, flags=re.M))


main()
