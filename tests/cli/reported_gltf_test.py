"""glTF files that people reported, and others of their kinds: REPORTED.md rows 28 to 35."""
import base64
import copy
import json
import struct
import unittest

from reported import Reported

CUBE = [(i & 1, i >> 1 & 1, i >> 2 & 1) for i in range(8)]
FACES = [0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5]
COMPONENTS = {"b": 5120, "B": 5121, "h": 5122, "H": 5123, "I": 5125, "f": 5126}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}


def flat(rows):
    return [v for row in rows for v in (row if isinstance(row, (tuple, list)) else [row])]


class Maker:
    """A glTF file of one unit cube, to which tests add what they are about."""

    def __init__(self, places=CUBE, faces=FACES):
        self.binary = b""
        self.json = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
                     "accessors": [], "bufferViews": []}
        primitive = {"attributes": {"POSITION": self.add(places, "VEC3", "f")}}
        if faces:
            primitive["indices"] = self.add(faces, "SCALAR", "H")
        self.json["meshes"] = [{"primitives": [primitive]}]

    @property
    def primitive(self):
        return self.json["meshes"][0]["primitives"][0]

    def add(self, rows, kind, code, normalized=False):
        numbers = flat(rows)
        data = struct.pack(f"<{len(numbers)}{code}", *numbers)
        self.json["bufferViews"].append({"buffer": 0, "byteOffset": len(self.binary), "byteLength": len(data)})
        self.binary += data + b"\0" * (-len(data) % 4)
        accessor = {"bufferView": len(self.json["bufferViews"]) - 1, "componentType": COMPONENTS[code],
                    "count": len(numbers) // WIDTHS[kind], "type": kind}
        if normalized:
            accessor["normalized"] = True
        self.json["accessors"].append(accessor)
        return len(self.json["accessors"]) - 1

    def glb(self, **more):
        whole = copy.deepcopy(self.json)
        whole.setdefault("buffers", [{"byteLength": len(self.binary)}])
        whole.update(more)
        text = json.dumps(whole).encode()
        text += b" " * (-len(text) % 4)
        binary = self.binary + b"\0" * (-len(self.binary) % 4)
        return (struct.pack("<4sIIII", b"glTF", 2, 28 + len(text) + len(binary), len(text), 0x4E4F534A) + text +
                struct.pack("<II", len(binary), 0x004E4942) + binary)

    def gltf(self):
        whole = dict(self.json)
        uri = "data:application/octet-stream;base64," + base64.b64encode(self.binary).decode()
        whole["buffers"] = [{"byteLength": len(self.binary), "uri": uri}]
        return json.dumps(whole)


class Gltf(Reported):
    def made(self, maker, name="made.glb"):
        return self.write(name, maker.glb() if name.endswith(".glb") else maker.gltf())

    def bounds(self, path):
        info = self.info(path)
        return info["bounds_min"] + info["bounds_max"]

    def close(self, found, right, tolerance=1e-5):
        self.assertEqual(len(found), len(right))
        for a, b in zip(found, right):
            self.assertAlmostEqual(a, b, delta=tolerance)

    def refused(self, path, *words):
        for command in (["info", path], ["convert", path, "-o", "o.vdb"]):
            result = self.fails(3, words[0], *command)
            for word in words:
                self.assertIn(word, result.stderr)
        return result

    # --- the files of the table

    def test_28_instances(self):
        path = self.file("28-glb-gpu-instancing.glb")
        self.close(self.bounds(path), [0, 0, 0, 28, 1, 1])
        out = self.convert(path, resolution=280)
        self.assertEqual(out.code, 0, out.said)
        # Cubes of ten voxels a side, with round edges.
        self.near(out.volume, 10, 0.08)

    def test_29_simple_skin(self):
        path = self.file("29-gltf-simple-skin.gltf")
        self.close(self.bounds(path), [-0.5, 0, 0, 0.5, 2, 0])
        self.assertIn("1 animation left out", self.ok("info", path).stderr)

    def test_30_armature_scale(self):
        out = self.convert("30-glb-skin-armature-scale.glb")
        self.assertEqual(out.code, 0, out.said)
        self.near(out.bounds[4] - out.bounds[1], 1.7)
        self.near(out.volume, 0.4 * 1.7 * 0.25, 0.03)

    def test_31_morph_weights(self):
        bounds = self.bounds(self.file("31-gltf-morph-weights/MorphPrimitivesTest.gltf"))
        self.close(bounds[1::3], [0, 0.1])

    def test_32_draco(self):
        self.refused(self.file("32-gltf-draco/2CylinderEngine.gltf"), "KHR_draco_mesh_compression",
                     "without compression")

    def test_33_gltf_1(self):
        self.refused(self.file("33-gltf-1.0/BoxTextured.gltf"), "glTF 1.0 is not read", "convert it to 2.0")

    def test_34_uri_with_blanks(self):
        out = self.convert(self.file("34-gltf-space uri/scene.gltf"))
        self.assertEqual(out.code, 0, out.said)
        self.near(out.volume, 1)

    def test_34_uri_with_blanks_generated(self):
        maker = Maker()
        self.write("my part #1.bin", maker.binary)
        for uri in ("my%20part%20%231.bin", "my part #1.bin"):
            self.write("a.gltf", json.dumps({**maker.json, "buffers": [{"byteLength": len(maker.binary), "uri": uri}]}))
            self.near(self.info(self.path("a.gltf"))["signed_volume"], 1, 1e-6)

    def test_35_points(self):
        path = self.file("35-glb-points.glb")
        info = self.info(path)
        self.assertEqual((info["kind"], info["points"]), ("points", 3000))
        self.close(info["bounds_min"] + info["bounds_max"],
                   [-1.99835169, -1.99873495, -1.99738061, 1.99922121, 1.99885118, 1.99846351])
        out = self.convert(path)
        self.assertEqual(out.code, 0, out.said)
        for low, high in zip(out.bounds[:3], out.bounds[3:]):
            self.near(high - low, 4, 0.15)

    # --- others of their kinds

    def test_28_instances_turned_and_scaled(self):
        for required in (False, True):
            maker = Maker()
            half = 23170  # of 32767: a quarter turn about y
            maker.json["nodes"][0]["extensions"] = {"EXT_mesh_gpu_instancing": {"attributes": {
                "TRANSLATION": maker.add([(0, 0, 0), (0, 0, 8)], "VEC3", "f"),
                "ROTATION": maker.add([(0, half, 0, half), (0, 0, 0, 32767)], "VEC4", "h", True),
                "SCALE": maker.add([(1, 1, 1), (2, 1, -1)], "VEC3", "f")}}}
            maker.json["extensionsRequired" if required else "extensionsUsed"] = ["EXT_mesh_gpu_instancing"]
            info = self.info(self.made(maker))
            self.close(info["bounds_min"] + info["bounds_max"], [0, 0, -1, 2, 1, 8], 1e-4)
            self.near(info["signed_volume"], 3, 1e-4)
            self.assertTrue(info["closed_manifold"])

    def test_29_skin_in_a_gltf_with_bytes_as_weights(self):
        maker = Maker()
        maker.primitive["attributes"].update(
            JOINTS_0=maker.add([(0, 1, 0, 0)] * 8, "VEC4", "H"),
            WEIGHTS_0=maker.add([(128, 128, 0, 0)] * 8, "VEC4", "B", True))
        maker.json["nodes"] = [{"mesh": 0, "skin": 0, "translation": [50, 0, 0]}, {"translation": [2, 0, 0]},
                               {"translation": [0, 6, 0]}]
        maker.json["skins"] = [{"joints": [1, 2]}]
        self.close(self.bounds(self.made(maker, "a.gltf")), [1, 3, 0, 2, 4, 1])

    def test_31_node_weights_over_mesh_weights(self):
        maker = Maker()
        maker.primitive["targets"] = [{"POSITION": maker.add([(0, 10, 0)] * 8, "VEC3", "f")},
                                      {"POSITION": maker.add([(1, 0, 0)] * 8, "VEC3", "b"), "NORMAL": 0}]
        maker.json["meshes"][0]["weights"] = [1, 0]
        self.close(self.bounds(self.made(maker)), [0, 10, 0, 1, 11, 1])
        maker.json["nodes"][0]["weights"] = [0.5, 4]
        self.close(self.bounds(self.made(maker)), [4, 5, 0, 5, 6, 1])

    def test_32_other_compressions_by_name(self):
        for name in ("KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_meshopt_compression",
                     "MESHOPT_compression"):
            maker = Maker()
            maker.json["extensionsRequired"] = maker.json["extensionsUsed"] = [name]
            self.refused(self.made(maker), name, "without compression")
        maker = Maker()
        maker.json["extensionsRequired"] = ["ACME_space_folding"]
        self.refused(self.made(maker), "ACME_space_folding", "not supported")

    def test_32_fallback(self):
        maker = Maker()
        name = "EXT_meshopt_compression"
        maker.json["extensionsUsed"] = [name]
        maker.json["bufferViews"][0]["extensions"] = {name: {"buffer": 0, "byteOffset": 0, "byteLength": 96}}
        self.near(self.info(self.made(maker))["signed_volume"], 1, 1e-6)
        maker.json["bufferViews"][0]["buffer"] = 1
        maker.json["buffers"] = [{"byteLength": len(maker.binary)},
                                 {"byteLength": 96, "extensions": {name: {"fallback": True}}}]
        self.refused(self.made(maker), name, "without compression")

    def test_33_binary_gltf_1(self):
        text = b'{"asset":{"version":"1.0"},"meshes":{}} '
        content = struct.pack("<4sIIII", b"glTF", 1, 20 + len(text), len(text), 0) + text
        self.refused(self.write("a.glb", content), "glTF 1.0", "convert it to 2.0")

    def test_35_points_and_lines_beside_faces(self):
        maker = Maker()
        maker.json["meshes"][0]["primitives"] += [{"mode": 0, "attributes": {"POSITION": 0}},
                                                  {"mode": 1, "attributes": {"POSITION": 0}}]
        path = self.made(maker)
        self.near(self.info(path)["signed_volume"], 1, 1e-6)
        self.assertIn("1 primitive of lines and 1 primitive of points left out", self.ok("info", path).stderr)
        maker.json["meshes"][0]["primitives"] = [{"mode": 3, "attributes": {"POSITION": 0}}]
        self.refused(self.made(maker), "only lines")

    def test_35_points_in_a_gltf_with_colours(self):
        maker = Maker([(x / 10, y / 10, 0.1 * (x + y)) for x in range(20) for y in range(20)], None)
        maker.primitive["mode"] = 0
        maker.primitive["attributes"]["COLOR_0"] = maker.add([(255, 0, 0, 255)] * 400, "VEC4", "B", True)
        info = self.info(self.made(maker, "a.gltf"))
        self.assertEqual((info["kind"], info["points"]), ("points", 400))

    def test_scenes_and_loose_nodes_are_said(self):
        maker = Maker()
        maker.json["scenes"].append({"nodes": [1]})
        maker.json["nodes"] += [{"mesh": 0}, {"mesh": 0}]
        said = self.ok("info", self.made(maker)).stderr
        self.assertIn("1 other scene with 1 node of meshes left out", said)
        self.assertIn("1 node with a mesh in no scene left out", said)


if __name__ == "__main__":
    unittest.main(verbosity=2)
