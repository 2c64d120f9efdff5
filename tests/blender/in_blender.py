"""Runs inside Blender: installs the add-on from its zip, operates every method, checks the objects. Prints one line OK or FAILED a check.
Usage: blender -b --factory-startup --python in_blender.py -- ADDON.zip PROGRAM FOLDER"""
import json
import os
import subprocess
import sys
import traceback

import bpy
import numpy as np

ADDON, PROGRAM, FOLDER = sys.argv[sys.argv.index("--") + 1:]


def path(name):
    return os.path.join(FOLDER, name)


def tool(*words):
    subprocess.run([PROGRAM, *map(str, words)], check=True, cwd=FOLDER, capture_output=True)


def bounds(one):
    points = np.array([one.matrix_world @ v.co for v in one.data.vertices])
    return points.min(0), points.max(0)


def select(one):
    bpy.ops.object.select_all(action="DESELECT")
    one.hide_set(False)
    one.select_set(True)
    bpy.context.view_layer.objects.active = one


def torus(location=(0, 0, 0), scale=1.0):
    bpy.ops.mesh.primitive_torus_add(location=location, major_radius=1.0, minor_radius=0.4, major_segments=64, minor_segments=24)
    made = bpy.context.active_object
    made.scale = (scale, scale, scale)
    bpy.context.view_layer.update()
    return made


def settings(command):
    return getattr(bpy.context.scene, "vdb_synth_" + command)


def run(command):
    before = set(bpy.data.objects)
    result = bpy.ops.vdb_synth.run(command=command)
    made = [one for one in bpy.data.objects if one not in before]
    return result, made[0] if made else None


def check_analogy():
    tool("make", "dilation", "a.vdb", "a2.vdb", "--resolution", 48)
    target = torus((5, 3, 1), 2.0)
    own = settings("analogy")
    own.plain_file, own.textured_file, own.resolution = path("a.vdb"), path("a2.vdb"), 64
    result, made = run("analogy")
    assert result == {"FINISHED"}, result
    low, high = bounds(target)
    new_low, new_high = bounds(made)
    voxel = (high - low).max() / 64
    # Dilated by four voxels of the pair: in place, and larger all round.
    assert (new_low < low).all() and (new_high > high).all()
    assert np.abs((new_low + new_high) / 2 - (low + high) / 2).max() < voxel
    assert target.hide_get() and bpy.context.view_layer.objects.active == made
    return made


def check_synth():
    tool("make", "balls", "balls.ply", "--resolution", 32)
    target = torus()
    own = settings("synth")
    own.size, own.resolution, own.draft = "1x,1x,2x", 48, True
    result, made = run("synth")
    assert result == {"FINISHED"} and len(made.data.polygons) > 500
    own.as_volume = True
    select(target)
    result, made = run("synth")
    assert result == {"FINISHED"} and made.type == "VOLUME" and os.path.isfile(bpy.path.abspath(made.data.filepath))
    made.data.grids.load()
    assert "surface" in [grid.name for grid in made.data.grids]
    own.as_volume = False
    # A volume goes in as its file.
    result, again = run("synth")
    assert result == {"FINISHED"}, result


def check_texture():
    image = bpy.data.images.new("stripes", 32, 32)
    pixels = np.ones((32, 32, 4), dtype=np.float32)
    pixels[::2, :, 1:3] = 0
    image.pixels.foreach_set(pixels.ravel())
    image.filepath_raw, image.file_format = path("stripes.png"), "PNG"
    image.save()
    target = torus()
    settings("texture").image_file = path("stripes.png")
    result, made = run("texture")
    assert result == {"FINISHED"} and len(made.data.polygons) >= len(target.data.polygons), (result, len(made.data.polygons))
    layer = made.data.color_attributes[0]
    values = np.zeros(len(layer.data) * 4, dtype=np.float32)
    layer.data.foreach_get("color", values)
    red = values.reshape(-1, 4)[:, 0]
    assert red.mean() > 0.5, red.mean()
    # Blender's colours are light: half as an image holds it is a fifth of it. They go out again with the mesh as they came in.
    srgb = np.zeros(len(layer.data) * 4, dtype=np.float32)
    layer.data.foreach_get("color_srgb", srgb)
    from vdb_synth import exchange, vdbsynth_ply as ply
    ply.write_ply(path("grey.ply"), np.eye(3), [(0, 1, 2)], np.full((3, 3), 128 / 255))
    grey = exchange.import_mesh(path("grey.ply"), "grey").data.color_attributes[0].data[0]
    assert abs(grey.color[0] - 0.2159) < 1e-3 and abs(grey.color_srgb[0] - 128 / 255) < 1e-3, tuple(grey.color)
    select(made)
    exchange.export_mesh(bpy.context, made, path("out.ply"))
    points, faces, attributes = ply.read_ply(path("out.ply"))
    assert len(points) == len(made.data.vertices)
    assert np.abs(ply.colours_of(attributes) - srgb.reshape(-1, 4)[:, :3]).max() < 2 / 255
    target.hide_set(False)


def check_relief():
    tool("make", "terrain", "sample.vdb", "--resolution", 48)
    target = torus()
    own = settings("relief")
    own.sample_file, own.resolution = path("sample.vdb"), 48
    result, made = run("relief")
    assert result == {"FINISHED"}, result
    low, high = bounds(target)
    new_low, new_high = bounds(made)
    assert np.abs(new_low - low).max() < 0.4 and np.abs(new_high - high).max() < 0.4


def check_patch():
    tool("make", "bumps", "bumps.vdb", "--resolution", 48)
    from vdb_synth import exchange
    volume = exchange.import_volume(path("bumps.vdb"), "bumps")
    bpy.context.scene.collection.objects.link(volume)
    select(volume)
    settings("patch").size = "2x,2x"
    result, made = run("patch")
    assert result == {"FINISHED"} and len(made.data.polygons) > 1000, (result, len(made.data.polygons))
    # A mesh goes out with its faces.
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=20, y_subdivisions=20, size=20)
    sheet = bpy.context.active_object
    sheet.modifiers.new("thick", "SOLIDIFY").thickness = 1
    result, made = run("patch")
    assert result == {"FINISHED"} and len(made.data.polygons) > 100, (result, len(made.data.polygons))


def check_compare():
    first, second = torus(), torus(scale=1.1)
    settings("compare").other_object = second
    select(first)
    result, _ = run("compare")
    assert result == {"FINISHED"}
    report = json.loads(bpy.data.texts[-1].as_string())
    assert "reference" in report or report


def check_errors_are_the_programs():
    torus()
    own = settings("analogy")
    own.plain_file = path("none.vdb")
    for wanted in ("none.vdb", "choose plain"):
        try:
            bpy.ops.vdb_synth.run(command="analogy")
        except RuntimeError as error:
            assert wanted in str(error), error
        else:
            raise AssertionError("no error")
        own.plain_file = ""
    with open(path("broken.vdb"), "wb") as file:
        file.write(b" BDV" + bytes(40))
    own.plain_file = own.textured_file = path("broken.vdb")
    try:
        bpy.ops.vdb_synth.run(command="analogy")
    except RuntimeError as error:
        assert "broken.vdb" in str(error), error
    else:
        raise AssertionError("no error")
    from vdb_synth import operators
    assert not operators.running


def check_settings_come_back():
    made = check_analogy()
    own = settings("analogy")
    own.resolution, own.seed = 30, 9
    select(made)
    assert bpy.ops.vdb_synth.settings() == {"FINISHED"}
    assert own.resolution == 64 and own.seed == 0
    assert bpy.context.view_layer.objects.active.name == json.loads(made["vdb_synth"])["target"]


def check_cancel():
    from vdb_synth import methods
    from vdb_synth.vdbsynth_tool import Job
    tool("make", "sponge", "sponge.vdb", "--resolution", 64)
    job = Job("synth", [path("sponge.vdb")], [path("never.vdb")], {"size": "4x,4x,4x"}, PROGRAM)
    job.cancel()
    job.wait(60)
    assert job.state.cancelled and not os.path.exists(path("never.vdb"))


def check_picture():
    made = check_analogy()
    scene = bpy.context.scene
    for one in bpy.data.objects:
        if one.type == "MESH" and one != made:
            one.hide_render = True
    made.hide_render = False
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    sun = bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN"))
    for one in (camera, sun):
        scene.collection.objects.link(one)
    camera.location, camera.rotation_euler = (5, -7, 8), (0.95, 0, 0)
    sun.data.energy, sun.rotation_euler = 3, (0.6, 0.3, 0)
    scene.camera = camera
    scene.render.engine, scene.cycles.samples, scene.cycles.use_denoising = "CYCLES", 8, False
    scene.render.resolution_x, scene.render.resolution_y = 320, 240
    scene.render.filepath = path("picture.png")
    bpy.ops.render.render(write_still=True)
    assert os.path.getsize(path("picture.png")) > 5000


def main():
    bpy.ops.preferences.addon_install(filepath=ADDON)
    bpy.ops.preferences.addon_enable(module="vdb_synth")
    bpy.context.preferences.addons["vdb_synth"].preferences.program = PROGRAM
    for name, check in list(globals().items()):
        if not name.startswith("check_"):
            continue
        try:
            check()
            print("OK", name[6:], flush=True)
        except Exception:  # each check on its own
            print("FAILED", name[6:], traceback.format_exc(), flush=True)
    bpy.ops.preferences.addon_disable(module="vdb_synth")
    print("OK disabled", flush=True)


main()
