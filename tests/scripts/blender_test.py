#!/usr/bin/env python3
"""Blender's compositor opens a film of the path tracer with all its layers: blender_test.py AIRLIGHT. Skipped where there is no Blender."""
import os
import shutil
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
LIST = """
import bpy, sys
bpy.context.scene.use_nodes = True
node = bpy.context.scene.node_tree.nodes.new("CompositorNodeImage")
node.image = bpy.data.images.load(sys.argv[-1])
print("pictures:", sorted(output.name for output in node.outputs))
for layer in ("order", "half", "batch"):
    node.layer = layer
    print(layer + ":", [output.name for output in node.outputs])
"""
EXPECTED = """pictures: ['Alpha', 'Combined', 'airlight', 'max_sample', 'n', 'se', 'surface', 'transmittance']
order: ['0', '1', '2', '3', '4', 'rest']
half: ['A', 'B']
batch: ['00', '01', '02', '03', '04', '05', '06', '07', '08', '09', '10', '11', '12', '13', '14', '15']"""

if len(sys.argv) != 2:
    sys.exit(__doc__)
if shutil.which("blender") is None:
    print("test skipped: there is no blender")
    sys.exit(0)
with tempfile.TemporaryDirectory() as folder:
    film, script = f"{folder}/film.exr", f"{folder}/list.py"
    subprocess.run([sys.argv[1], "render", f"{ROOT}/experiments/scenes/constant_homogeneous.toml", "-m", "path_tracer", "--samples", "16",
                    "--override", "film.width=8", "--override", "film.height=6", "-o", film], check=True)
    with open(script, "w", encoding="utf-8") as file:
        file.write(LIST)
    said = subprocess.run(["blender", "--background", "--factory-startup", "--python", script, "--", film], capture_output=True, text=True,
                          check=True).stdout
    found = "\n".join(line for line in said.splitlines() if line.split(":")[0] in ("pictures", "order", "half", "batch"))
    assert found == EXPECTED, f"expected\n{EXPECTED}\nfound\n{found}\n{said}"
print("Blender names all layers")
