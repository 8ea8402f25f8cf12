#!/usr/bin/env python3
"""scripts/gallery on a small tree of its own: what it draws, and what it objects to."""
import importlib.machinery
import importlib.util
import os
import random
import re
import shutil
import struct
import subprocess
import sys
import unittest
import zlib

from small_tree import SOURCE, Tree

GALLERY = """[[picture]]
name = "one"
title = "One"
caption = "a picture"
exposure = 0
height = 2
[[picture.scene]]
file = "scenes/a.toml"
[[picture.panel]]
label = "truth"
method = "exact"
[[picture.panel]]
label = "ours"
method = "fast"
settings = { K = 3 }
"""
# In place of the program: writes down what it is asked for, and pictures of 960x4 pixels, 0 and 1 in turns. A frame takes as many seconds as
# the file "seconds" said when it was rendered; without the file 0.5.
PROGRAM = """#!/usr/bin/env python3
import array, os, struct, sys, zlib
here = os.path.dirname(os.path.abspath(__file__))
with open(here + "/log", "a") as log:
    log.write(" ".join(sys.argv[1:]) + "\\n")
if sys.argv[1] == "render":
    seconds = open(here + "/seconds").read() if os.path.exists(here + "/seconds") else "0.5"
    open(sys.argv[sys.argv.index("--out") + 1], "w").write(seconds)
elif sys.argv[1] == "info":
    print("  seconds =", open(sys.argv[2]).read())
elif sys.argv[1] == "doctor":
    print("  processor  A Processor, 2 threads")
elif sys.argv[1] == "compare":
    print("rel_l2                   0.25 [0.24, 0.26]  (floor 0.004)")
    if "--map" in sys.argv:
        chunk = lambda kind, data: struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
        with open(sys.argv[sys.argv.index("--map") + 1], "wb") as png:
            png.write(b"\\x89PNG\\r\\n\\x1a\\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 480, 2, 8, 2, 0, 0, 0)))
            png.write(chunk(b"IDAT", zlib.compress((b"\\0" + bytes([253, 231, 37]) * 480) * 2)) + chunk(b"IEND", b""))
else:
    with open(sys.argv[3], "wb") as pfm:
        pfm.write(b"PF\\n960 4\\n-1.0\\n" + array.array("f", [0, 0, 0, 1, 1, 1] * 1920).tobytes())
"""


@unittest.skipIf(sys.version_info < (3, 11) or not shutil.which("gnuplot"), "no tomllib or no gnuplot")
class Gallery(Tree):
    def setUp(self):
        super().setUp()
        self.write("experiments/gallery.toml", GALLERY)
        self.write("experiments/scenes/a.toml", "[camera]\n")
        self.write("results/README.md", "![one](gallery/one.png)\n")
        self.write("build/release/airlight", PROGRAM)
        os.chmod(f"{self.root}/build/release/airlight", 0o755)

    def renders(self):
        return [line.split() for line in self.read("build/release/log").split("\n") if line.startswith("render")]

    def test_renders_what_has_changed(self):
        code, text = self.run_script("gallery")
        self.assertEqual(code, 0, text)
        self.assertEqual(self.run_script("gallery", "--check"), (0, "1 pictures, 0 faults\n"))
        self.assertEqual([r[r.index("--method") + 1] for r in self.renders()], ["exact", "fast"])
        self.assertIn("film.width=960", self.renders()[0])
        self.assertEqual(self.run_script("gallery")[0], 0)
        self.assertEqual(len(self.renders()), 2)
        self.write("experiments/gallery.toml", GALLERY.replace("K = 3", "K = 4"))
        self.objects(1, "results/gallery/one.png was drawn of another entry", "--check")
        self.assertEqual(self.run_script("gallery")[0], 0)
        self.assertEqual(self.run_script("gallery", "--check")[0], 0)
        self.assertEqual(["--set" in r and r[r.index("--set") + 1] for r in self.renders()[2:]], ["K=4"])
        self.write("experiments/scenes/a.toml", "[camera] # another\n")
        self.assertEqual(self.run_script("gallery", "--check")[0], 0)
        self.assertEqual(self.run_script("gallery")[0], 0)
        self.assertEqual(len(self.renders()), 5)
        self.write("experiments/scenes/a.toml", "[camera]\nvertical_fov = 1\n")
        self.objects(1, "or other scenes", "--check")

    def test_panels_are_means_over_pixels(self):
        picture = self.module("picture", "scripts/gallery_page/picture.py")
        pfm = f"{self.root}/x.pfm"
        subprocess.run([f"{self.root}/build/release/airlight", "convert", "x.exr", pfm], check=True)
        # The mean of two zeros and two ones is 0.5, in sRGB 1.055 * 0.5^(1/2.4) - 0.055 = 0.7354, of 255: 187.5.
        self.assertEqual(picture.shown(pfm, 2, 0), bytes([188]) * (480 * 2 * 3))
        self.assertEqual(picture.shown(pfm, 2, 1), bytes([255]) * (480 * 2 * 3))

    def module(self, name, file):
        loader = importlib.machinery.SourceFileLoader(name, f"{self.root}/{file}")
        module = importlib.util.module_from_spec(importlib.util.spec_from_loader(name, loader))
        sys.dont_write_bytecode = True
        loader.exec_module(module)
        return module

    def test_maps_stand_below_the_methods(self):
        self.assertEqual(self.run_script("gallery")[0], 0)
        log = self.read("build/release/log")
        self.assertIn("--map-top 1.0 --map-shrink 2", log)  # the first of 1, 2, 5 times a power of ten from 3 times the error on
        self.assertEqual(log.count("--map "), 1)  # none of the reference
        height = self.height()
        self.write("experiments/gallery.toml", GALLERY.replace("height = 2", "height = 2\nmaps = false"))
        self.assertEqual(self.run_script("gallery")[0], 0)
        self.assertEqual(self.read("build/release/log").count("--map "), 1)
        self.assertEqual(height - self.height(), 24 + 80)  # a line of text, and the scale, which is higher than the map

    def test_a_film(self):
        film = 'maps = false\nrate = 5\nfilm = { "light.0.scale" = [1, 2, 3] }'
        self.write("experiments/gallery.toml", GALLERY.replace("height = 2", f"height = 2\n{film}"))
        code, text = self.run_script("gallery")
        self.assertEqual(code, 0, text)
        self.assertEqual(self.run_script("gallery", "--check"), (0, "1 pictures, 0 faults\n"))
        self.assertEqual([next(v for v in r if v.startswith("light")) for r in self.renders()],
                         [f"light.0.scale={scale}" for scale in (1, 1, 2, 2, 3, 3)])
        self.assertIn("a looping film of 3 frames, 5 a second: `light.0.scale` from 1 to 3.", self.read("results/gallery/README.md"))
        with open(f"{self.root}/results/gallery/one.png", "rb") as stream:
            parts = list(self.module("picture", "scripts/gallery_page/picture.py").chunks(stream.read()))
        kinds = [kind for kind, _ in parts if kind in (b"acTL", b"fcTL", b"fdAT")]
        self.assertEqual(kinds, [b"acTL", b"fcTL", b"fcTL", b"fdAT", b"fcTL", b"fdAT"])
        self.assertEqual([int.from_bytes(c[:4], "big") for kind, c in parts if kind in (b"fcTL", b"fdAT")], [0, 1, 2, 3, 4])
        later = [c for kind, c in parts if kind == b"fcTL"][1]
        self.assertEqual([int.from_bytes(later[i:i + 4], "big") for i in (4, 8, 12, 16)], [964, 2, 4, 114])  # two panels and what is between
        data = zlib.decompress([c for kind, c in parts if kind == b"fdAT"][0][4:])
        self.assertEqual([c for kind, c in parts if kind == b"tRNS"], [b"\0\xff\0\0\0\xff"])  # what does not change: here every pixel
        row = b"\xff\0\xff" * 964
        self.assertEqual((data[0], data[1 + 964 * 3]), (1, 2))  # less the pixel to the left, less the row above
        self.assertEqual(data[1:1 + 964 * 3], bytes((a - b) & 255 for a, b in zip(row, bytes(3) + row)))
        self.assertEqual(data[2 + 964 * 3:], bytes(964 * 3))

    def height(self):
        with open(f"{self.root}/results/gallery/one.png", "rb") as stream:
            return int.from_bytes(stream.read(24)[20:], "big")

    def test_colours_are_those_of_the_program(self):
        with open(f"{SOURCE}/experiments/judging/error_map.cpp") as stream:
            listed = re.findall(r"\{(\d+), (\d+), (\d+)\}", stream.read())
        self.assertEqual(self.module("picture", "scripts/gallery_page/picture.py").VIRIDIS, [tuple(map(int, colour)) for colour in listed])

    def test_times(self):
        gallery = self.module("gallery", "scripts/gallery")
        gallery.disturbed = lambda before, after: False  # other tests run beside this one
        self.write("build/release/seconds", "12")
        row = "| {} | {} | once | {} | {} | {} |\n"
        reference = row.format("truth", "exact", "defaults", "reference, noise 0.4 %", "12 s *")
        self.assertEqual(gallery.main([]), 0)
        self.assertIn(reference + row.format("ours", "fast", "K = 3", "25 %", "12 s *"), self.read("results/gallery/README.md"))
        self.assertEqual(gallery.main(["--times"]), 0)
        self.assertEqual(len(self.renders()), 2)  # frames of 12 s are timed once
        self.write("experiments/gallery.toml", GALLERY.replace("K = 3", "K = 4"))
        self.write("build/release/seconds", "0.5")
        self.assertEqual(gallery.main([]), 0)
        self.assertIn(reference + row.format("ours", "fast", "K = 4", "25 %", "500 ms *"), self.read("results/gallery/README.md"))
        self.assertEqual(gallery.main(["--times"]), 0)
        self.assertEqual(len(self.renders()), 7)  # one of the second panel, which is short, and then three
        self.assertEqual(gallery.main(["--times"]), 0)
        self.assertEqual(len(self.renders()), 7)  # both have their times
        page = self.read("results/gallery/README.md")
        self.assertIn(row.format("ours", "fast", "K = 4", "25 %", "500 ms"), page)
        self.assertIn("Film: 960x4 pixels, each pixel of a panel (480x2) is the mean of 2x2. Processor: A Processor, 2 threads.", page)
        os.remove(f"{self.root}/build/release/airlight")  # the page comes from the picture alone
        self.assertEqual(self.run_script("gallery", "--page")[0], 0)
        self.assertEqual(self.read("results/gallery/README.md"), page)
        self.assertEqual(self.run_script("gallery", "--check")[0], 0)

    def test_no_times_of_a_busy_machine(self):
        gallery = self.module("gallery", "scripts/gallery")
        self.assertFalse(gallery.disturbed((1, 10, 100), (3, 12.1, 102)))  # others used 0.1 s of 2 s
        self.assertTrue(gallery.disturbed((1, 10, 100), (2, 12, 102)))
        gallery.disturbed = lambda before, after: True
        self.assertEqual(gallery.main(["--times"]), 2)  # there is no picture yet
        self.assertEqual(gallery.main([]), 0)
        self.assertEqual(gallery.main(["--times"]), 0)
        self.assertIn("| ours | fast | once | K = 3 | 25 % |  |\n", self.read("results/gallery/README.md"))

    def objects(self, code, word, *command):
        got, text = self.run_script("gallery", *command)
        self.assertEqual(got, code, text)
        self.assertIn(word, text)
        return text

    def test_bad_input(self):
        for old, new, word in (
                ("exposure = 0", "exposur = 0", "gallery.toml:5: unknown key 'exposur' of a picture (nearest: exposure)"),
                ("exposure = 0", "exposure = '0'", "gallery.toml:5: 'exposure' of a picture is '0', expected a number"),
                ("K = 3 }", "K = 3 }\nmetod = 'x'", "gallery.toml:16: unknown key 'metod' of a panel (nearest: method)"),
                ("caption = \"a picture\"\n", "", "gallery.toml:1: a picture has no 'caption'"),
                ("height = 2", "height = 0", "gallery.toml:1: 'height' is 0, expected 1 to 1024"),
                ("height = 2", "height = 2\nwidth = 0", "gallery.toml:1: 'width' is 0, expected 1 to 1024"),
                ("height = 2", 'height = 2\nmaps = false\nfilm = { "a.b" = [1, 2], "a.c" = [1] }', "gallery.toml:1: each key of 'film' needs a list"),
                ("height = 2", 'height = 2\nfilm = { "a.b" = [1, 2] }', "gallery.toml:1: a film has one scene, maps = false, and no"),
                ("title = ", "title ", "experiments/gallery.toml: Expected '='")):
            self.write("experiments/gallery.toml", GALLERY.replace(old, new))
            self.assertEqual(self.objects(2, word, "--check").count("\n"), 1)
        self.write("experiments/gallery.toml", GALLERY)
        self.objects(2, "unknown picture 'on' (nearest: one)", "on")

    def test_large_pictures_keep_fewer_colours(self):
        sys.path.insert(0, f"{SOURCE}/scripts/gallery_page")
        from picture import chunk, compressed, decompressed, no_larger_than
        noise, white = random.Random(4), bytes([255] * 3)
        rows = [b"".join(white if x < 5 else bytes(noise.randrange(255) for _ in range(3)) for x in range(40)) for _ in range(30)]
        head = struct.pack(">IIBBBBB", 40, 30, 8, 2, 0, 0, 0)
        png = b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", compressed(rows)) + chunk(b"IEND", b"")
        self.assertEqual(decompressed(png), rows)
        self.assertEqual(no_larger_than(png, len(png)), png)
        smaller = no_larger_than(png, len(png) - 1)
        self.assertLess(len(smaller), len(png))
        found = b"".join(decompressed(smaller))
        self.assertLessEqual(max(abs(a - b) for a, b in zip(found, b"".join(rows))), 1)
        self.assertTrue(all(row.startswith(white * 5) for row in decompressed(smaller)))
        with self.assertRaisesRegex(ValueError, "split it"):
            no_larger_than(png, 100)

    def test_what_is_missing(self):
        self.assertEqual(self.run_script("gallery")[0], 0)
        self.write("results/README.md", "")
        self.objects(1, "neither README.md nor results/README.md links to results/gallery/one.png", "--check")
        self.write("results/gallery/README.md", "")
        self.objects(1, "results/gallery/README.md is not what experiments/gallery.toml says", "--check")
        self.assertEqual(self.run_script("gallery", "--page")[0], 0)
        self.write("results/gallery/two.png", "")
        self.objects(1, "results/gallery/two.png: no entry of experiments/gallery.toml draws it", "--check")
        os.remove(f"{self.root}/results/gallery/one.png")
        self.objects(1, "results/gallery/one.png is missing", "--check")
        os.remove(f"{self.root}/experiments/scenes/a.toml")
        self.objects(1, "one: there is no experiments/scenes/a.toml", "--check")
        self.objects(2, "scenes/a.toml: No such file or directory")


if __name__ == "__main__":
    unittest.main()
