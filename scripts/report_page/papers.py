"""What README.md and results/README.md say about the papers: verdicts, and one entry for each figure, table and claim."""
import collections
import html
import os
import re

NAME = re.compile(r"[a-z]\w*(?:/[a-z]\w*)?(?:\.paper)?")


def cells(line):
    return [cell.strip() for cell in line.strip().strip("|").split("|")]


def words(markdown):
    """The text without Markdown."""
    return re.sub(r"\[([^\]]*)\](\([^)]*\))?", r"\1", markdown).replace("`", "").replace("**", "")


def paragraph(markdown):
    """HTML of a line of Markdown. Its links become text, since their targets are no part of the page."""
    return re.sub(r"`([^`]*)`", r"<code>\1</code>", html.escape(re.sub(r"\[([^\]]*)\](\([^)]*\))?", r"\1", markdown)))


def verdicts(text):
    """The rows of README.md's table of papers: (folder of the method, cells by the heading of their column)."""
    folders = dict(re.findall(r"^\[([^\]]+)\]: methods/(\w+)/README.md$", text, re.M))
    rows = [cells(line) for line in text.split("\n") if line.startswith("|")]
    head = next(i for i, row in enumerate(rows) if row[0] == "Paper")
    found = []
    for row in rows[head + 2:]:
        name = re.match(r"\[([^\]]+)\]", row[0])
        if not name or name.group(1) not in folders:
            break
        found.append((folders[name.group(1)], {heading: words(cell) for heading, cell in zip(rows[head], row)}))
    return found


class Entry:
    """A figure, table or claim of a paper, or a subject of its own."""

    def __init__(self, chapter, label, text, verdict=""):
        self.chapter, self.label, self.text, self.verdict = chapter, words(label), text, verdict
        self.pictures = re.findall(r"gallery/(\w+\.png)", text)
        self.names, group = [], ""
        for code in re.findall(r"`([^`]+)`", label) + re.findall(r"`([^`]+)`|\((?=[a-z_]+/)([^)]*)\)", text):
            name = code if isinstance(code, str) else code[0] or code[1]
            if not NAME.fullmatch(name):
                continue
            group = name.split("/")[0] if "/" in name else group  # "`fogshop/fig1`, `fig2`" names fogshop/fig2
            self.names.append(name if "/" in name else f"{group}/{name}")


def entries(text):
    """The table rows below each heading of results/README.md."""
    found, chapter, head = [], "", []
    for block in re.split(r"\n(?=#|- |\||\n)", text):
        line = " ".join(block.split())
        if line.startswith("## "):
            chapter, head = line[3:], []
        elif line.startswith("|") and chapter:
            row = cells(line)
            if not head:
                head, first = row, int(row[0] == "paper")  # a table over all papers names the paper before the place
            elif not line.startswith("|--") and not (first and "verdict" in head):  # failing claims are in their paper's table, too
                named = [(name[0].upper() + name[1:], cell) for name, cell in zip(head, row)][first + 1:]
                parts = [f"{name}: {cell}" for name, cell in named if cell not in ("", "-")]
                found.append(Entry(chapter, row[first], "\n".join(parts), dict(zip(head, row)).get("verdict", "").removesuffix(" †")))
                if first and found[-1].names:
                    found[-1].chapter = found[-1].names[0].split("/")[0]
        else:
            head = []
    for entry in found:
        named = collections.Counter(name.split("/")[0] for other in found if other.chapter == entry.chapter for name in other.names)
        entry.group = named.most_common(1)[0][0] if named else entry.chapter
    return found


def read(root, name, reader):
    path = os.path.join(root, name)
    if not os.path.exists(path):
        return []
    with open(path, encoding="utf-8") as file:
        return reader(file.read())
