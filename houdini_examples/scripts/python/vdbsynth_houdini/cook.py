"""What a SOP of this package does when it cooks. The only module of the package that touches hou; its calls are those of SideFX's documentation.

Geometry goes out as .vdb or .ply (.obj where the program takes .ply as points) and comes back as .vdb, .ply or .obj: no .bgeo, no transform, no scale.
Houdini's polygons are wound clockwise seen from outside, those of files counter-clockwise, so faces are reversed both ways.
"""
import json
import os
import shutil
import tempfile

import hou
import numpy as np
import vdbsynth_ply as ply
import vdbsynth_tool as tool

from . import methods, runs

REPORT = "vdbsynth_report"  # detail attribute: what the program reported, as JSON


def cook(node, command):
    """`node` is the Python SOP that cooks: the asset itself, or a node inside it."""
    one = methods.method(command)
    asset = node if node.parm("vdbsynth_program") else node.parent()
    folder = tempfile.mkdtemp(prefix="vdb_synth_houdini_")
    try:
        warnings = []
        outcome = run(one, node, asset, folder, warnings)
        bring(node.geometry(), outcome, one)
    except (tool.ToolError, ValueError, OSError) as error:
        raise hou.NodeError(str(error))
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    warnings += outcome.warnings
    if warnings:
        raise hou.NodeWarning("\n".join(warnings))  # at the end: Houdini keeps the geometry


def run(one, node, asset, folder, warnings):
    paths = {}
    for role in one.roles:
        paths[role.name] = input_path(role, one, node, asset, folder, warnings)
    inputs = [paths[name] for name in one.order]
    values = {option.parm: asset.parm(option.parm).eval() if option.kind != "choice" else asset.parm(option.parm).evalAsString()
              for option in one.options}
    options = methods.options_of(one, values, [os.path.splitext(path)[1][1:].lower() for path in inputs])
    result = asset.parm("vdbsynth_result").evalAsString()
    request = runs.Request(one.command, inputs, options, one.extension(result), asset.parm("vdbsynth_program").evalAsString())
    cache = asset.parm("vdbsynth_cache").evalAsString()
    with hou.InterruptableOperation(f"vdb_synth {one.command}", open_interrupt_dialog=True) as operation:
        outcome = runs.run(request, cache, lambda stage, fraction: operation.updateProgress(fraction))
    runs.trim(cache, asset.parm("vdbsynth_cache_size").eval() * 2**30)
    return outcome


def input_path(role, one, node, asset, folder, warnings):
    index = one.wired.index(role) if role.wired else -1
    sources = node.inputs()
    if 0 <= index < len(sources) and sources[index] is not None:
        return export(sources[index].geometry(), os.path.join(folder, role.name), role, one, warnings)
    path = asset.parm(role.parm).evalAsString()
    if not path:
        raise ValueError(f"{role.label}: " + (f"connect input {index + 1} or choose a file" if role.wired else "choose a file"))
    if not os.path.isfile(path):
        raise ValueError(f"{role.label}: {path} is not there")
    return path


def export(geometry, stem, role, one, warnings):
    """Writes one input; returns its path."""
    points = geometry.intrinsicValue("pointcount")
    volumes, polygons = geometry.countPrimType(hou.primType.VDB), geometry.countPrimType(hou.primType.Polygon)
    total = geometry.intrinsicValue("primitivecount")
    if volumes:
        if polygons:
            raise ValueError(f"{role.label}: has polygons and VDBs; send one of them")
        geometry.saveToFile(stem + ".vdb")
        return stem + ".vdb"
    if total > polygons:
        warnings.append(f"{role.label}: {total - polygons} primitives are neither polygons nor VDBs and were left out; Unpack or Convert makes polygons")
    if points == 0 or (polygons == 0 and total > 0):
        raise ValueError(f"{role.label}: has neither polygons, VDBs nor points")
    table = np.array(geometry.pointFloatAttribValues("P")).reshape(-1, 3)
    faces = closed_faces(geometry, role, warnings) if polygons else []
    if one.command == "patch" and faces:
        write_obj(stem + ".obj", table, faces)
        return stem + ".obj"
    colours = None
    if geometry.findPointAttrib("Cd") is not None:
        colours = np.array(geometry.pointFloatAttribValues("Cd")).reshape(-1, 3)
    ply.write_ply(stem + ".ply", table, faces, colours)
    return stem + ".ply"


def closed_faces(geometry, role, warnings):
    faces, dropped = [], 0
    for prim in geometry.iterPrims():
        if prim.type() != hou.primType.Polygon:
            continue
        corners = [vertex.point().number() for vertex in prim.vertices()]
        if not prim.isClosed() or not 3 <= len(corners) <= 255:
            dropped += 1
            continue
        faces.append(corners[::-1])
    if dropped:
        warnings.append(f"{role.label}: {dropped} open curves or degenerate polygons were left out")
    if not faces:
        raise ValueError(f"{role.label}: has no closed polygons")
    return faces


def write_obj(path, points, faces):
    with open(path, "w") as file:
        file.writelines("v %.9g %.9g %.9g\n" % tuple(point) for point in points)
        file.writelines("f " + " ".join(str(corner + 1) for corner in face) + "\n" for face in faces)


def bring(geometry, outcome, one):
    """The result in place of the first input's geometry, or its numbers on it."""
    extension = os.path.splitext(outcome.path)[1]
    report = outcome.report
    if extension == ".json":
        with open(outcome.path) as file:
            report = json.load(file)
    elif extension == ".ply":
        geometry.clear()
        bring_ply(geometry, outcome.path)
    else:
        geometry.clear()
        geometry.loadFromFile(outcome.path)  # Houdini's own readers of .vdb and .obj
    geometry.addAttrib(hou.attribType.Global, REPORT, "")
    geometry.setGlobalAttribValue(REPORT, json.dumps({**report, "messages": outcome.messages}))  # notes too: nothing is kept silent


def bring_ply(geometry, path):
    points, faces, attributes = ply.read_ply(path)
    geometry.createPoints(points.tolist())
    if faces:
        geometry.createPolygons([face[::-1] for face in faces])
    colours = ply.colours_of(attributes)
    if colours is not None:
        geometry.addAttrib(hou.attribType.Point, "Cd", (1.0, 1.0, 1.0))
        geometry.setPointFloatAttribValues("Cd", colours.ravel().tolist())
