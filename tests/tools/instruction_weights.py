#!/usr/bin/env python3
"""tests/tools/instruction_weights.py OUT: instructions between the marks of tests/tools/loop_counts.py, from RADV's disassembly.

Compiles the shaders under OUT/dump for gfx1100, which need not be there, each mark an exchange in a buffer of its own place, and
writes OUT/weights.csv: of each scene, shader and mark (-1: what every invocation does; `loop`: in loops of a shader without marks)
how many instructions a lane issues, by the unit that does them; and OUT/shaders.csv: registers, shared memory, scratch. A mark counts
what no way leads to but through it; conditions without one are taken as met. Debian: glslang-tools, mesa-vulkan-drivers, libvulkan-dev."""
import collections
import csv
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

SOURCE = pathlib.Path(__file__).resolve().parent / "pipeline_statistics.cpp"
DRIVER = "/usr/share/vulkan/icd.d/radeon_icd.x86_64.json"
UNITS = ["issue", "f32", "f64", "int", "special", "memory"]
COUNTED = re.compile(r"#define COUNT_TRIPS 1\n#if COUNT_TRIPS\nuint trips\[\d+\];\nbool trip\(int k\) \{ \+\+trips\[k\]; return true; \}")
MARKED = ("#define COUNT_TRIPS 0\nlayout(std430, binding = 31) restrict buffer Trips { int trips[]; };\n"
          "bool trip(int k) { atomicExchange(trips[k], 1); return true; }\n#if COUNT_TRIPS")
IGNORED = re.compile(r"s_(waitcnt|delay_alu|nop|clause|sendmsg|endpgm|inst_prefetch|code_end)|buffer_atomic_swap")


def cost(operation):
    """An instruction's: by unit, what it takes of it (memory: words of 4 bytes)."""
    name, units = operation.split()[0], collections.Counter(issue=1)
    if name.startswith("v_dual"):
        units.update(issue=1, f32=2)
    elif name.startswith("v_"):
        if re.search(r"v_(exp|log|rcp|rsq|sqrt|sin|cos)_|v_cvt.*f64", name):
            units["special"] += 1
        elif "_f64" in name:
            units["f64"] += 1
        elif re.search(r"_f32|v_mov", name) and "cmp" not in name and not re.search("min|max", name):
            units["f32"] += 1
        else:
            units["int"] += 1
    elif re.match(r"(buffer|global|scratch|ds|flat)_", name):
        bits = re.search(r"[bu](\d+)", name)
        units["memory"] += int(bits.group(1)) / 32 if bits and int(bits.group(1)) > 32 else 1
    return units


def instructions(disassembly):
    """Operations in order, the places of labels, and the loops as ranges of places."""
    lines, labels, loops = [], {}, []
    for line in disassembly.splitlines():
        if match := re.match(r"(BB\d+):", line):
            labels[match.group(1)] = len(lines)
        elif match := re.match(r"\t([a-z].*?)\s*;", line):
            lines.append(match.group(1))
    for place, line in enumerate(lines):
        target = re.match(r"s_c?branch\S* (BB\d+)", line)
        if target and labels[target.group(1)] <= place:
            loops.append((labels[target.group(1)], place))
    return lines, labels, sorted(set(loops), key=lambda loop: (loop[0], -loop[1]))


def mark_of(line):
    match = re.match(r"buffer_atomic_swap_b32 .*?(?:offset:(\d+))?$", line)
    return int(match.group(1) or 0) // 4 if match else None


def blocks_of(lines, labels):
    """Blocks of a program as (begin, end) line numbers, and the dominators of each block, nearest first."""
    branches = {p: re.match(r"s_(c?)branch\S* (BB\d+)", line) for p, line in enumerate(lines)}
    begins = sorted({0} | set(labels.values()) | {p + 1 for p, branch in branches.items() if branch} - {len(lines)})
    begins = [b for b in begins if b < len(lines)]
    blocks = list(zip(begins, begins[1:] + [len(lines)]))
    number = {begin: b for b, begin in enumerate(begins)}
    before = collections.defaultdict(list)
    for b, (_, end) in enumerate(blocks):
        branch = branches[end - 1]
        if branch and labels[branch.group(2)] in number:
            before[number[labels[branch.group(2)]]].append(b)
        if b + 1 < len(blocks) and not (branch and not branch.group(1)):
            before[b + 1].append(b)
    everything = (1 << len(blocks)) - 1
    dominators, changed = [1] + [everything] * (len(blocks) - 1), True
    while changed:
        changed = False
        for b in range(1, len(blocks)):
            common = everything
            for p in before[b]:
                common &= dominators[p]
            changed |= common | 1 << b != dominators[b]
            dominators[b] = common | 1 << b
    depth = [bin(d).count("1") for d in dominators]
    return blocks, [sorted((d for d in range(len(blocks)) if dominators[b] >> d & 1 and d != b), key=lambda d: -depth[d])
                    for b in range(len(blocks))]


def weights(disassembly, has_marks):
    """Instructions by mark and unit. Copies of a mark are merged into one with their mean."""
    lines, labels, loops = instructions(disassembly)
    marks = [mark_of(line) for line in lines]
    blocks, dominators = blocks_of(lines, labels)
    loop_of = [next(((b, e) for b, e in reversed(loops) if b <= begin <= e), None) for begin, _ in blocks]
    found, copies = collections.defaultdict(collections.Counter), collections.Counter(m for m in marks if m is not None)

    def last_mark(block):
        return next((m for m in reversed(marks[slice(*blocks[block])]) if m is not None), None)

    def mark_before(block):
        """Last mark of the nearest dominating block, in this loop or one around it."""
        begin, loop = blocks[block][0], loop_of[block]
        if not has_marks:
            return "loop" if loop else -1
        if loop and begin == loop[0]:  # the head runs as often as its own mark, which is the first in the loop
            own = next((m for m in marks[loop[0]:loop[1] + 1] if m is not None), None)
            if own is not None:
                return own
        for d in dominators[block]:
            around = loop_of[d]
            if around and not around[0] <= begin <= around[1]:
                continue
            if last_mark(d) is not None:
                return last_mark(d)
            if around and blocks[d][0] == around[0]:
                return mark_before(d)
        return -1
    for block, (begin, end) in enumerate(blocks):
        mark = mark_before(block)
        for line, here in zip(lines[begin:end], marks[begin:end]):
            if here is not None:
                mark = here
            elif not IGNORED.match(line):
                found[mark].update(cost(line))
    return {m: {unit: units[unit] / max(1, copies[m]) for unit in UNITS} for m, units in found.items()}


def compiled(tool, text, folder):
    """The disassembly and the statistics of a shader."""
    file = pathlib.Path(folder) / "shader.comp"
    file.write_text(text)
    spirv = file.with_suffix(".spv")
    subprocess.run(["glslangValidator", "-V", "-R", "--auto-map-locations", "--auto-map-bindings", "-o", spirv, file],
                   check=True, stdout=subprocess.DEVNULL)
    environment = dict(os.environ, RADV_FORCE_FAMILY="gfx1100", VK_ICD_FILENAMES=DRIVER, MESA_SHADER_CACHE_DISABLE="true",
                       RADV_DEBUG="shaders")
    result = subprocess.run([tool, spirv], capture_output=True, text=True, env=environment, check=True)
    statistics = dict(line.split("\t")[1:3] for line in result.stdout.splitlines())
    return result.stderr[result.stderr.rindex("disasm:"):], statistics


def main():
    if len(sys.argv) != 2 or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    out, known = pathlib.Path(sys.argv[1]), {}
    missing = [name for name in ("glslangValidator", "g++") if not shutil.which(name)] + [DRIVER] * (not os.path.exists(DRIVER))
    if missing:
        print("there is no " + ", no ".join(missing) + "; Debian: glslang-tools, mesa-vulkan-drivers, libvulkan-dev, g++", file=sys.stderr)
        sys.exit(3)
    dumps = sorted(out.glob("dump/*/*.comp"))
    if not dumps:
        sys.exit(f"instruction_weights: no shader in {out}/dump: run tests/tools/loop_counts.py {out} first")
    rows, shaders, kept = [], [], set()
    with tempfile.TemporaryDirectory() as folder:
        tool = pathlib.Path(folder) / "pipeline_statistics"
        subprocess.run(["g++", "-O1", "-std=c++20", SOURCE, "-o", tool, "-lvulkan"], check=True)
        marked = {(file.parent, file.stem.rsplit("-", 1)[0]) for file in dumps if COUNTED.search(file.read_text())}
        for file in dumps:
            key, text = (file.parent, file.stem.rsplit("-", 1)[0]), file.read_text()
            has_marks = bool(COUNTED.search(text))
            if has_marks != (key in marked):
                continue
            text = COUNTED.sub(MARKED, text)
            if text not in known:
                disassembly, statistics = compiled(tool, text, folder)
                known[text] = weights(disassembly, has_marks), statistics
            found, statistics = known[text]
            alike = (*key, str(found), statistics["VGPRs"])
            if alike in kept:  # variants that differ by what is counted elsewhere
                continue
            kept.add(alike)
            head = [file.parent.name, key[1], file.stem[-12:]]
            rows += [[*head, mark, *(f"{units[unit]:.6g}" for unit in UNITS)] for mark, units in found.items()]
            shaders.append([*head, *(statistics[name] for name in ("VGPRs", "Spilled VGPRs", "Scratch size", "LDS size", "Instructions"))])
            print(*shaders[-1], flush=True)
    columns = ["registers", "spilled", "scratch", "shared", "instructions"]
    for name, head, table in (("weights", ["mark", *UNITS], rows), ("shaders", columns, shaders)):
        with open(out / f"{name}.csv", "w", newline="") as file:
            csv.writer(file, lineterminator="\n").writerows([["scene", "shader", "variant", *head], *table])


if __name__ == "__main__":
    main()
