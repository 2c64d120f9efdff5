"""3MF in and out: files as slicers write them (made here by Python's zipfile), and ours as others read them."""
import io
import json
import subprocess
import unittest
import xml.etree.ElementTree as Tree
import zipfile

from support import PROGRAM, CliTest

CORE = "{http://schemas.microsoft.com/3dmanufacturing/core/2015/02}"
MATERIAL = "{http://schemas.microsoft.com/3dmanufacturing/material/2015/02}"
CORNERS = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
QUADS = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))


def cube(number, attributes="", side=10):
    """An object; its first face (two triangles) is green by the group 9."""
    vertices = "".join(f'<vertex x="{side * x}" y="{side * y}" z="{side * z}"/>' for x, y, z in CORNERS)
    triangles = "".join(f'<triangle v1="{a}" v2="{b}" v3="{c}"{tint}/><triangle v1="{a}" v2="{c}" v3="{d}"{tint}/>'
                        for (a, b, c, d), tint in zip(QUADS, [' pid="9" p1="0"'] + [""] * 5))
    return f'<object id="{number}" type="model" {attributes}><mesh><vertices>{vertices}</vertices><triangles>{triangles}</triangles></mesh></object>'


def model(resources, build, attributes='unit="millimeter"'):
    return (f'<?xml version="1.0" encoding="UTF-8"?><model {attributes} xmlns="{CORE[1:-1]}" xmlns:m="{MATERIAL[1:-1]}" '
            'xmlns:p="http://schemas.microsoft.com/3dmanufacturing/production/2015/06" requiredextensions="p">'
            f'<resources>{resources}</resources><build>{build}</build></model>')


def package(files, method=zipfile.ZIP_DEFLATED):
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w", method) as archive:
        archive.writestr("_rels/.rels", '<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships"><Relationship '
                         'Target="/3D/3dmodel.model" Id="a" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>')
        for name, text in files.items():
            archive.writestr(name, text)
    return content.getvalue()


GREEN = '<m:colorgroup id="9"><m:color color="#00FF00FF"/></m:colorgroup><basematerials id="8"><base name="a" displaycolor="#FF0000"/></basematerials>'
# As Bambu Studio and others write it: an object of components, whose meshes are in another model file.
SLICER = {
    "3D/3dmodel.model": model('<object id="1" type="model"><components><component p:path="/3D/Objects/a.model" objectid="4"/>'
                              '<component p:path="/3D/Objects/a.model" objectid="4" transform="1 0 0 0 1 0 0 0 1 30 0 0"/></components></object>',
                              '<item objectid="1" transform="1 0 0 0 1 0 0 0 1 0 0 5" printable="1"/>'),
    "3D/Objects/a.model": model(GREEN + cube(4, 'pid="8" pindex="0"'), ""),
}


class ThreeMf(CliTest):
    def info(self, name):
        return json.loads(self.ok("info", name, "--json").stdout)

    def test_the_minimal_wall_is_said_and_reported(self):
        mesh = model('<object id="1" type="model"><mesh><vertices>' + "".join(
            f'<vertex x="{20 * x}" y="{20 * y}" z="{2 * z}"/>' for x, y, z in CORNERS) + "</vertices><triangles>" + "".join(
            f'<triangle v1="{a}" v2="{b}" v3="{c}"/><triangle v1="{a}" v2="{c}" v3="{d}"/>' for a, b, c, d in QUADS) +
            "</triangles></mesh></object>", '<item objectid="1"/>')
        self.write("plate.3mf", package({"3D/3dmodel.model": mesh}))
        for name, verbose, said in (("o.stl", ["-v"], True), ("o.3mf", ["-v"], True), ("o.obj", ["-v"], False), ("o.stl", [], False)):
            done = self.ok("convert", "plate.3mf", "-o", name, "--voxel-size", "0.5", "--report", "r.json", "--force", *verbose)
            self.assertEqual("minimal wall 2 (world), near" in done.stderr, said)
            counts = json.loads(self.read("r.json"))["counts"]
            self.assertAlmostEqual(counts["minimal_wall"], 2, delta=0.15)
            self.assertEqual(len(counts["minimal_wall_at"]), 3)

    def root(self, name):
        archive = zipfile.ZipFile(self.path(name))
        self.assertIsNone(archive.testzip())
        self.assertEqual({entry.date_time for entry in archive.infolist()}, {(1980, 1, 1, 0, 0, 0)})
        return Tree.fromstring(archive.read("3D/3dmodel.model"))

    def test_a_slicers_file_is_a_mesh_for_every_command(self):
        for method in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
            self.write("a.3mf", package(SLICER, method))
            info = self.info("a.3mf")
            self.assertAlmostEqual(info["signed_volume"], 2000, places=3)
            self.assertEqual(info["bounds_max"], [40, 10, 15])
            self.assertEqual(info["closed_parts"], 2)
        self.ok("convert", "a.3mf", "-o", "a.vdb", "-o", "b.3mf", "-o", "a.ply", "--resolution", 48)
        grids = {grid["name"]: grid["type"] for grid in self.info("a.vdb")["grids"]}
        self.assertEqual(grids, {"surface": "float", "Cd": "vec3s"})
        self.ok("render", "a.3mf", "-o", "a.png")
        self.assertIn("unit of the world is a millimetre", self.ok("convert", "a.vdb", "-o", "c.3mf", "-v").stderr)

    def test_parts_and_colours_are_written(self):
        self.write("a.3mf", package(SLICER))
        self.ok("convert", "a.3mf", "-o", "b.3mf", "--resolution", 48)
        root = self.root("b.3mf")
        self.assertEqual(root.get("unit"), "millimeter")
        objects = root.findall(f"{CORE}resources/{CORE}object")
        self.assertEqual([len(o.findall(f"{CORE}mesh")) for o in objects], [1, 1, 0])
        self.assertEqual(len(objects[2].findall(f".//{CORE}component")), 2)
        self.assertEqual([i.get("objectid") for i in root.findall(f"{CORE}build/{CORE}item")], [objects[2].get("id")])
        colours = [c.get("color") for c in root.iter(f"{MATERIAL}color")]
        for wanted in ("#FF0000FF", "#00FF00FF"):
            self.assertIn(wanted, colours)
        info = self.info("b.3mf")
        self.assertTrue(abs(info["signed_volume"] - 2000) < 120, info)
        self.assertEqual((info["closed_parts"], info["open_edges"], info["non_manifold_edges"]), (2, 0, 0))
        for mesh in root.iter(f"{CORE}mesh"):
            edges = {}
            for t in mesh.iter(f"{CORE}triangle"):
                a, b, c = t.get("v1"), t.get("v2"), t.get("v3")
                for edge in ((a, b), (b, c), (c, a)):
                    self.assertNotIn(edge, edges)
                    edges[edge] = True
            self.assertTrue(all((b, a) in edges for a, b in edges))

    def test_the_same_bytes_again_and_through_pipes(self):
        self.write("a.3mf", package(SLICER))
        self.ok("convert", "a.3mf", "-o", "a.vdb", "--resolution", 40)
        for threads in (1, 3):
            self.ok("convert", "a.vdb", "-o", f"t{threads}.3mf", "--threads", threads)
        self.assertEqual(self.read("t1.3mf"), self.read("t3.3mf"))
        piped = subprocess.run([PROGRAM, "convert", "-", "-o", "-.3mf", "--resolution", "40"], input=self.read("a.3mf"),
                               capture_output=True, cwd=self.folder, timeout=240)
        self.assertEqual(piped.returncode, 0, piped.stderr)
        self.assertEqual(piped.stdout, self.read("t1.3mf"))

    def test_losses_are_said(self):
        inches = {"3D/3dmodel.model": model(GREEN + cube(1) + cube(2, 'displaced=""'), '<item objectid="1"/>', 'unit="inch"')}
        self.write("a.3mf", package(inches))
        said = self.ok("convert", "a.3mf", "-o", "a.vdb", "--resolution", 24).stderr
        self.assertIn("a.3mf: its unit is inch, and coordinates stay as they are; --unit-scale 25.4 reads them as millimetres", said)
        self.assertIn("1 object that nothing places left out", said)
        self.ok("convert", "a.3mf", "-o", "b.vdb", "--resolution", 24, "--unit-scale", 25.4)
        rows = "\n".join(f"{x} {y} {z} {x + y}" for x, y, z in CORNERS)
        faces = "\n".join("4 " + " ".join(map(str, q)) for q in QUADS)
        self.write("heat.ply", "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\nproperty float heat\n"
                   f"element face 6\nproperty list uchar int vertex_indices\nend_header\n{rows}\n{faces}\n")
        said = self.ok("convert", "heat.ply", "-o", "heat.3mf", "--resolution", 24).stderr
        self.assertIn("heat.3mf: .3mf has no place for heat", said)

    def test_hostile_files_are_one_line(self):
        whole = package(SLICER)
        for size in range(0, len(whole), 97):
            self.write("cut.3mf", whole[:size])
            self.fails(3, "cut.3mf", "info", "cut.3mf")
        self.write("bomb.3mf", package({"3D/3dmodel.model": model("", "").replace("<build>", " " * 200_000_000 + "<build>")}))
        self.fails(1, "bomb.3mf", "info", "bomb.3mf", "--max-memory", "100M")
        self.write("text.3mf", "solid")
        self.fails(3, "text.3mf: is no ZIP archive", "info", "text.3mf")
        again = {"3D/3dmodel.model": model('<object id="1"><components><component objectid="1"/></components></object>', '<item objectid="1"/>')}
        self.write("again.3mf", package(again))
        self.fails(3, "object 1 is a component of itself", "convert", "again.3mf", "-o", "x.vdb")
        self.assertNotIn("x.vdb", self.files())


if __name__ == "__main__":
    unittest.main()
