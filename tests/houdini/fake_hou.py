"""The part of Houdini's hou module that the package calls, after SideFX's public reference (names, arguments, what is raised). Calls that the reference
does not have fail here. A SOP's geometry is plain lists, or a .vdb file. Installed as `hou` by install()."""
import enum
import shutil
import sys
import types


class Error(Exception):
    pass


class NodeError(Error):
    pass


class NodeWarning(Error):
    pass


class OperationInterrupted(Error):
    pass


class primType(enum.Enum):
    VDB, Polygon, PackedGeometry = range(3)


class attribType(enum.Enum):
    Point, Prim, Vertex, Global = range(4)


class stringParmType(enum.Enum):
    Regular, FileReference = range(2)


class InterruptableOperation:
    """interrupt_after: how often updateProgress answers before "Escape" is pressed; None: never."""
    interrupt_after = None
    calls = []

    def __init__(self, operation_name, long_operation_name=None, open_interrupt_dialog=False, timeout_ms=0):
        self.name = operation_name

    def __enter__(self):
        return self

    def __exit__(self, *_):
        return False

    def updateProgress(self, percentage=-1.0):
        assert percentage == -1.0 or 0.0 <= percentage <= 1.0, percentage
        InterruptableOperation.calls.append(percentage)
        if self.interrupt_after is not None and len(InterruptableOperation.calls) > self.interrupt_after:
            raise OperationInterrupted()


class Point:
    def __init__(self, number):
        self._number = number

    def number(self):
        return self._number


class Vertex:
    def __init__(self, number):
        self._number = number

    def point(self):
        return Point(self._number)


class Prim:
    def __init__(self, kind, corners=(), closed=True):
        self._kind, self._corners, self._closed = kind, corners, closed

    def type(self):
        return self._kind

    def vertices(self):
        return tuple(Vertex(corner) for corner in self._corners)

    def isClosed(self):
        return self._closed


class Geometry:
    def __init__(self, points=(), faces=(), colours=None, vdb="", others=0, curves=()):
        self.points, self.vdb, self.loaded, self.globals = [tuple(point) for point in points], vdb, "", {}
        self.attributes = {} if colours is None else {"Cd": [float(value) for colour in colours for value in colour]}
        self.prims = [Prim(primType.Polygon, face) for face in faces] + [Prim(primType.Polygon, curve, False) for curve in curves]
        self.prims += [Prim(primType.VDB)] * bool(vdb) + [Prim(primType.PackedGeometry)] * others

    def intrinsicValue(self, intrinsic_name):
        return {"pointcount": len(self.points) + bool(self.vdb), "primitivecount": len(self.prims)}[intrinsic_name]

    def countPrimType(self, prim_type):
        return sum(prim.type() == prim_type for prim in self.prims)

    def iterPrims(self):
        return iter(self.prims)

    def pointFloatAttribValues(self, name):
        return tuple(value for point in self.points for value in point) if name == "P" else tuple(self.attributes[name])

    def findPointAttrib(self, name):
        return name if name in self.attributes else None

    def saveToFile(self, file_name):
        assert file_name.endswith(".vdb") and self.vdb
        shutil.copyfile(self.vdb, file_name)

    def loadFromFile(self, file_name):
        open(file_name).close()
        self.loaded = file_name

    def clear(self):
        self.__init__()

    def createPoints(self, positions):
        self.points += [tuple(position) for position in positions]

    def createPolygons(self, points, is_closed=True):
        for corners in points:
            assert all(0 <= corner < len(self.points) for corner in corners)
        self.prims += [Prim(primType.Polygon, tuple(corners), is_closed) for corners in points]

    def addAttrib(self, type, name, default_value, transform_as_normal=False, create_local_variable=True):
        if type == attribType.Point:
            self.attributes[name] = list(default_value) * len(self.points)
        else:
            self.globals[name] = default_value

    def setPointFloatAttribValues(self, name, values):
        assert len(values) == len(self.attributes[name]), (len(values), len(self.attributes[name]))
        self.attributes[name] = list(values)

    def setGlobalAttribValue(self, name_or_attrib, attrib_value):
        assert name_or_attrib in self.globals
        self.globals[name_or_attrib] = attrib_value


class Parm:
    def __init__(self, value, tokens=()):
        self._value, self._tokens = value, tokens

    def eval(self):
        return self._tokens.index(self._value) if self._tokens else self._value

    def evalAsString(self):
        return str(self._value)


class SopNode:
    def __init__(self, parms, inputs=(), geometry=None, parent=None):
        self._parms, self._inputs, self._geometry, self._parent = parms, inputs, geometry or Geometry(), parent

    def parm(self, parm_path):
        return self._parms.get(parm_path)

    def inputs(self):
        return tuple(self._inputs)

    def geometry(self, output_index=0):
        return self._geometry

    def parent(self):
        return self._parent


class _Template:
    def __init__(self, name, label, *arguments, **more):
        self.name, self.label, self.arguments, self.more = name, label, arguments, more


class IntParmTemplate(_Template):
    def __init__(self, name, label, num_components, default_value=(), min=0, max=10, help=None):
        super().__init__(name, label)
        assert len(default_value) == num_components


class FloatParmTemplate(IntParmTemplate):
    pass


class StringParmTemplate(_Template):
    def __init__(self, name, label, num_components, default_value=(), string_type=stringParmType.Regular, help=None):
        super().__init__(name, label)
        assert isinstance(string_type, stringParmType) and len(default_value) == num_components


class ToggleParmTemplate(_Template):
    def __init__(self, name, label, default_value=False, help=None):
        super().__init__(name, label)


class MenuParmTemplate(_Template):
    def __init__(self, name, label, menu_items, menu_labels=(), default_value=0, help=None):
        super().__init__(name, label)
        assert len(menu_items) == len(menu_labels) and 0 <= default_value < len(menu_items)


class ParmTemplateGroup:
    def __init__(self, parm_templates=()):
        self.templates = list(parm_templates)
        names = [template.name for template in self.templates]
        assert len(set(names)) == len(names), names


class HDADefinition:
    def __init__(self, name):
        self._name, self.sections, self.group = name, {}, None

    def nodeTypeName(self):
        return self._name

    def setParmTemplateGroup(self, parm_template_group, rename_conflicting_parms=False, create_backup=True):
        self.group = parm_template_group

    def addSection(self, name, contents="", compression_type=None):
        self.sections[name] = contents


class Network:
    """A node that is built, not cooked."""

    def __init__(self, kind="", name=None):
        self.kind, self.parms, self.wires, self.children, self.destroyed = kind, {}, {}, [], False

    def createNode(self, node_type_name, node_name=None):
        self.children.append(Network(node_type_name, node_name))
        return self.children[-1]

    def parm(self, parm_path):
        return types.SimpleNamespace(set=lambda value: self.parms.update({parm_path: value}))

    def indirectInputs(self):
        return tuple(f"input{index}" for index in range(4))

    def setInput(self, input_index, item_to_become_input, output_index=0):
        self.wires[input_index] = item_to_become_input

    def setDisplayFlag(self, on):
        pass

    def setRenderFlag(self, on):
        pass

    def createDigitalAsset(self, name=None, hda_file_name=None, description=None, min_num_inputs=0, max_num_inputs=0):
        open(hda_file_name, "w").close()
        definition = HDADefinition(name)
        libraries[hda_file_name] = [definition]
        return types.SimpleNamespace(type=lambda: types.SimpleNamespace(definition=lambda: definition))

    def destroy(self):
        self.destroyed = True


libraries = {}


class hda:
    @staticmethod
    def definitionsInFile(file_path):
        return tuple(libraries[file_path])

    @staticmethod
    def collapseFromDirectory(file_path, directory_path):
        with open(directory_path + "/INDEX__SECTION") as file:
            libraries[file_path] = [HDADefinition(file.readline().split()[1])]


def node(path):
    return Network()


def install():
    sys.modules["hou"] = sys.modules[__name__]
