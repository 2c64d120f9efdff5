"""Between Blender's objects and files: world space both ways, so that results lie where their source is."""
import os

import bpy
import numpy as np

from . import vdbsynth_ply as ply

SETTINGS = "vdb_synth"  # custom property of results: the run that made them, as JSON


def linear_of(colours):
    """Light, which Blender's colours are, of values as pictures and .ply files hold them (sRGB); [n, 3] from 0 to 1."""
    colours = np.clip(colours, 0.0, 1.0)
    return np.where(colours <= 0.04045, colours / 12.92, ((colours + 0.055) / 1.055) ** 2.4)


def srgb_of(light):
    """The inverse of linear_of; [n, 3], cut to 0 to 1."""
    light = np.clip(light, 0.0, 1.0)
    return np.where(light <= 0.0031308, light * 12.92, 1.055 * light ** (1 / 2.4) - 0.055)


def point_colours(mesh):
    """[n, 3] of light from 0 to 1, or None; colours of corners are averaged to points."""
    layer = mesh.color_attributes.active_color if len(mesh.color_attributes) else None
    if layer is None:
        return None
    values = np.zeros(len(layer.data) * 4, dtype=np.float32)
    layer.data.foreach_get("color", values)
    values = values.reshape(-1, 4)[:, :3].astype(np.float64)
    if layer.domain == "POINT":
        return values
    corners = np.zeros(len(mesh.loops), dtype=np.int32)
    mesh.loops.foreach_get("vertex_index", corners)
    sums, counts = np.zeros((len(mesh.vertices), 3)), np.zeros(len(mesh.vertices))
    np.add.at(sums, corners, values)
    np.add.at(counts, corners, 1)
    return sums / np.maximum(counts, 1)[:, None]


def export_mesh(context, scene_object, path):
    """The object with its modifiers as the scene shows it."""
    evaluated = scene_object.evaluated_get(context.evaluated_depsgraph_get())
    mesh = evaluated.to_mesh()
    try:
        points = np.zeros(len(mesh.vertices) * 3, dtype=np.float32)
        mesh.vertices.foreach_get("co", points)
        matrix = np.array(scene_object.matrix_world)
        points = points.reshape(-1, 3).astype(np.float64) @ matrix[:3, :3].T + matrix[:3, 3]
        faces = [tuple(polygon.vertices) for polygon in mesh.polygons]
        if np.linalg.det(matrix[:3, :3]) < 0:  # a mirrored object turns its faces inside out
            faces = [face[::-1] for face in faces]
        if path.endswith(".off"):
            ply.write_off(path, points, faces)
            return
        light = point_colours(mesh)
        ply.write_ply(path, points, faces, None if light is None else srgb_of(light))
    finally:
        evaluated.to_mesh_clear()


def export_object(context, scene_object, folder, name, kind="ply"):
    """Writes what an object is made of, a mesh as .ply or .off; returns the path. Volumes are read from their own file. Raises ValueError."""
    if scene_object.type == "VOLUME":
        path = bpy.path.abspath(scene_object.data.filepath)
        if not os.path.isfile(path):
            raise ValueError(f"{scene_object.name}: its .vdb file {path or '(none)'} is not there")
        return path
    if scene_object.type not in {"MESH", "CURVE", "SURFACE", "FONT", "META"}:
        raise ValueError(f"{scene_object.name}: is a {scene_object.type.lower()}; select a mesh or a volume")
    path = os.path.join(folder, f"{name}.{kind}")
    export_mesh(context, scene_object, path)
    return path


def import_mesh(path, name):
    points, faces, attributes = (*ply.read_off(path), {}) if path.endswith(".off") else ply.read_ply(path)
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(points.tolist(), [], faces)
    colours = ply.colours_of(attributes)
    if colours is not None:
        layer = mesh.color_attributes.new(name="Col", type="FLOAT_COLOR", domain="POINT")
        layer.data.foreach_set("color", np.concatenate([linear_of(colours), np.ones((len(colours), 1))], axis=1).astype(np.float32).ravel())
    mesh.validate()
    mesh.update()
    return bpy.data.objects.new(name, mesh)


def import_volume(path, name):
    volume = bpy.data.volumes.new(name)
    volume.filepath = path
    return bpy.data.objects.new(name, volume)
