"""Runs inside Blender for blender_pictures.sh: operates the add-on as an artist does and draws what comes of it into FOLDER/NAME.png.
Usage: blender [-b] --factory-startup --python blender_pictures.py -- FOLDER PROGRAM NAME"""
import math
import os
import sys

import bpy
import mathutils

FOLDER, PROGRAM, NAME = sys.argv[sys.argv.index("--") + 1:]
CLAY, STONE, GOLD, MINT = (0.52, 0.5, 0.47), (0.55, 0.19, 0.09), (0.72, 0.42, 0.09), (0.08, 0.36, 0.3)


def path(name):
    return os.path.join(FOLDER, name)


def select(one):
    bpy.ops.object.select_all(action="DESELECT")
    one.hide_set(False)
    one.select_set(True)
    bpy.context.view_layer.objects.active = one


def monkey():
    bpy.ops.mesh.primitive_monkey_add(size=2)
    made = bpy.context.active_object
    made.modifiers.new("Subdivision", "SUBSURF").levels = 2
    bpy.ops.object.shade_smooth()
    bpy.context.view_layer.update()
    return made


def run(command, target, **values):
    """What the panel's button does; returns the result, with smooth shading."""
    own = getattr(bpy.context.scene, "vdb_synth_" + command)
    for key, value in values.items():
        setattr(own, key, value)
    select(target)
    before = set(bpy.data.objects)
    assert bpy.ops.vdb_synth.run(command=command) == {"FINISHED"}
    made = next(one for one in bpy.data.objects if one not in before)
    select(made)
    bpy.ops.object.shade_smooth()
    return made


def analogy(target, kind, **values):
    return run("analogy", target, plain_file=path(kind + "_A.vdb"), textured_file=path(kind + "_A2.vdb"), **values)


def material(name, colour=None, roughness=0.45):
    """A plain colour, or the colours of the result (its attribute Col)."""
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    surface = made.node_tree.nodes["Principled BSDF"]
    surface.inputs["Roughness"].default_value = roughness
    if colour:
        surface.inputs["Base Color"].default_value = (*colour, 1)
    else:
        attribute = made.node_tree.nodes.new("ShaderNodeAttribute")
        attribute.attribute_name = "Col"
        made.node_tree.links.new(attribute.outputs["Color"], surface.inputs["Base Color"])
    return made


def dress(one, colour=None):
    one.data.materials.clear()
    one.data.materials.append(material(one.name, colour))


def corners(one):
    return [one.matrix_world @ mathutils.Vector(corner) for corner in one.bound_box]


def place(one, middle, longest):
    """Stands an object on the ground at (x, y), its longest side `longest`."""
    one.scale *= longest / max(one.dimensions)
    bpy.context.view_layer.update()
    points = corners(one)
    low = [min(p[i] for p in points) for i in range(3)]
    high = [max(p[i] for p in points) for i in range(3)]
    one.location += mathutils.Vector((middle[0] - (low[0] + high[0]) / 2, middle[1] - (low[1] + high[1]) / 2, -low[2]))
    bpy.context.view_layer.update()


def lamp(name, location, towards, size, watts, colour):
    made = bpy.data.objects.new(name, bpy.data.lights.new(name, "AREA"))
    made.data.size, made.data.energy, made.data.color = size, watts, colour
    made.location = location
    made.rotation_euler = (mathutils.Vector(towards) - made.location).to_track_quat("-Z", "Y").to_euler()
    bpy.context.scene.collection.objects.link(made)


def studio(shown, width, height, direction, samples):
    """Ground, three lamps, and a camera that the shown objects fill; draws NAME.png."""
    scene = bpy.context.scene
    for one in bpy.data.objects:
        one.hide_render = one not in shown
    bpy.ops.mesh.primitive_plane_add(size=400)
    dress(bpy.context.active_object, (0.3, 0.32, 0.36))
    points = [p for one in shown for p in corners(one)]
    middle = sum(points, mathutils.Vector()) / len(points)
    lamp("key", middle + mathutils.Vector((-6, -6, 7)), middle, 3, 1100, (1, 0.92, 0.82))
    lamp("rim", middle + mathutils.Vector((6, 6, 5)), middle, 3, 800, (0.8, 0.9, 1))
    world = bpy.data.worlds.new("sky")
    world.use_nodes = True
    world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.62, 0.7, 0.8, 1)
    world.node_tree.nodes["Background"].inputs["Strength"].default_value = 0.25
    scene.world = world
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    scene.collection.objects.link(camera)
    scene.camera = camera
    scene.render.resolution_x, scene.render.resolution_y = width, height
    camera.data.lens = 70
    camera.rotation_euler = mathutils.Vector(direction).to_track_quat("Z", "Y").to_euler()
    bpy.context.view_layer.update()
    at, _ = camera.camera_fit_coords(bpy.context.evaluated_depsgraph_get(), [value for p in points for value in p])
    camera.location = mathutils.Vector(at) + mathutils.Vector(direction).normalized() * 0.8
    scene.render.engine = "CYCLES"
    scene.cycles.samples, scene.cycles.use_denoising, scene.cycles.max_bounces = samples, False, 4
    scene.view_settings.view_transform, scene.view_settings.look = "Filmic", "Medium High Contrast"
    scene.render.filepath = path(NAME + ".png")
    bpy.ops.render.render(write_still=True)


def draw_analogy():
    """The monkey, and the same with the textures of two pairs."""
    plain = monkey()
    shown = [plain]
    for kind, colour in (("scales", MINT), ("holes", STONE)):
        shown.append(analogy(plain, kind, direction="axis:z", resolution=180))
        dress(shown[-1], colour)
        plain.hide_set(False)
    dress(plain, CLAY)
    for number, one in enumerate(shown):
        one.rotation_euler = (0, 0, math.radians(22 - 14 * number))
        place(one, (2.6 * number, 0), 2.4)
    studio(shown, 900, 320, (0, -1, 0.22), 96)


def volume(name):
    from vdb_synth import exchange
    made = exchange.import_volume(path(name + ".vdb"), name)
    bpy.context.scene.collection.objects.link(made)
    return made


def draw_methods():
    """More of a foam, a torus coloured like bricks, a sheet of flowers."""
    foam = run("synth", volume("foam"), size="2x,2x,1x")
    dress(foam, GOLD)
    bpy.ops.mesh.primitive_torus_add(major_radius=1.0, minor_radius=0.42, major_segments=260, minor_segments=110)
    ring = bpy.context.active_object
    bricks = run("texture", ring, image_file=path("bricks.png"), direction="around:z", scale=1.0)
    dress(bricks)
    bricks.rotation_euler = (math.radians(35), 0, 0)
    sheet = run("patch", volume("flowers"), size="2x,2x")
    dress(sheet, MINT)
    shown = [foam, bricks, sheet]
    for number, one in enumerate(shown):
        place(one, (2.6 * number, 0), 2.4)
    studio(shown, 900, 320, (0, -1, 0.5), 96)


def view_of(window):
    area = next(one for one in window.screen.areas if one.type == "VIEW_3D")
    return area, next(one for one in area.regions if one.type == "WINDOW"), next(one for one in area.regions if one.type == "UI")


def open_panels():
    """The Analogy panel open and the others closed, as a click on each leaves them."""
    from vdb_synth import methods
    kinds = [getattr(bpy.types, "VDBSYNTH_PT_" + one.command) for one in methods.METHODS]
    for kind in kinds:
        bpy.utils.unregister_class(kind)
        kind.bl_options = set() if kind.bl_idname.endswith("analogy") else {"DEFAULT_CLOSED"}
    for kind in kinds:
        bpy.utils.register_class(kind)


def draw_panel():
    """A picture of the window after a click on the button Analogy."""
    for one in list(bpy.data.objects):
        bpy.data.objects.remove(one)
    plain = monkey()
    bpy.ops.wm.save_as_mainfile(filepath=path("monkey.blend"))
    made = run("analogy", plain, plain_file="//scales_A.vdb", textured_file="//scales_A2.vdb", direction="axis:z", resolution=160)
    open_panels()
    window = bpy.context.window_manager.windows[0]
    area, _, _ = view_of(window)
    with bpy.context.temp_override(window=window, area=area):
        bpy.ops.screen.screen_full_area()
    steps = iter((show_sidebar, *(lambda one, event=event: point_at_tab(one, *event) for event in (
        ("MOUSEMOVE", "NOTHING"), ("LEFTMOUSE", "PRESS"), ("LEFTMOUSE", "RELEASE"))), lambda one: None, shoot))

    def step():
        todo = next(steps, None)
        if todo is None:
            return None
        todo(window)
        return 1.5

    bpy.app.timers.register(step, first_interval=2.0)


def show_sidebar(window):
    area, region, _ = view_of(window)
    space = area.spaces[0]
    space.show_region_ui, space.show_region_toolbar = True, False
    space.shading.show_cavity, space.shading.color_type, space.shading.single_color = True, "SINGLE", (0.45, 0.62, 0.56)
    with bpy.context.temp_override(window=window, area=area, region=region):
        bpy.ops.view3d.view_axis(type="FRONT")
        bpy.ops.view3d.view_orbit(angle=math.radians(20), type="ORBITLEFT")
        bpy.ops.view3d.view_selected()


def point_at_tab(window, kind, value):
    """The last of the tabs along the sidebar's right side; Blender 3.4 has no other way to choose one."""
    _, _, region = view_of(window)
    window.event_simulate(type=kind, value=value, x=region.x + region.width - 12, y=region.y + region.height - 172)


def shoot(window):
    with bpy.context.temp_override(window=window):
        bpy.ops.screen.screenshot(filepath=path(NAME + ".png"))
    bpy.ops.wm.quit_blender()


bpy.context.preferences.view.show_splash = False
bpy.ops.preferences.addon_install(filepath=path("addon.zip"))
bpy.ops.preferences.addon_enable(module="vdb_synth")
bpy.context.preferences.addons["vdb_synth"].preferences.program = PROGRAM
globals()["draw_" + NAME]()
