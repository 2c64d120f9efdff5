// Keywords of render.
#include "python/vdbsynth/option_keywords.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"

namespace vdbsynth::python {

template <>
struct Words<UpAxis> {
    static constexpr const char* kType = "Literal['y', 'z']";
    static constexpr std::pair<const char*, UpAxis> kAll[] = {{"y", UpAxis::Y}, {"z", UpAxis::Z}};
};
template <>
struct Value<Background> {
    static std::string type() { return "str"; }
    static std::string text(const Background&) { return "'studio'"; }
    static Background from(const std::string& name, py::handle value) {
        if (!py::isinstance<py::str>(value)) refuse(name, "str", value);
        const std::string text = py::cast<std::string>(value);
        Background background;
        if (!parseBackground(text, background))
            throw Error(ErrorCode::InvalidOption,
                        "`" + name + "` " + text +
                            ": must be studio, transparent, white, grey, black or a colour such as #203040");
        return background;
    }
};
// Width and height.
template <>
struct Value<std::array<int, 2>> {
    static std::string type() { return "Sequence[int]"; }
    static std::string text(const std::array<int, 2>& size) {
        return "(" + std::to_string(size[0]) + ", " + std::to_string(size[1]) + ")";
    }
    static std::array<int, 2> from(const std::string& name, py::handle value) {
        const std::string wanted = "(width, height)";
        const std::vector<py::object> sides = elementsFrom(name, value, wanted);
        if (sides.size() != 2) refuse(name, wanted, value);
        return {Value<int>::from(name, sides[0]), Value<int>::from(name, sides[1])};
    }
};
// "z=0.5", or ("z", 0.5).
template <>
struct Value<SlicePlace> {
    static std::string type() { return "str | tuple[str, float]"; }
    static std::string text(const SlicePlace& place) {
        return "('" + std::string(1, char('x' + place.axis)) + "', " + realText(place.fraction) + ")";
    }
    static SlicePlace from(const std::string& name, py::handle value) {
        std::string axis;
        SlicePlace place;
        bool sound = true;
        if (py::isinstance<py::str>(value)) {
            const std::string text = py::cast<std::string>(value);
            const std::size_t equals = text.find('=');
            axis = text.substr(0, equals);
            sound = equals != std::string::npos && parseReal(text.substr(equals + 1), place.fraction);
        } else {
            const std::string wanted = "an axis and a fraction, ('z', 0.5)";
            const std::vector<py::object> parts = elementsFrom(name, value, wanted);
            if (parts.size() != 2 || !py::isinstance<py::str>(parts[0])) refuse(name, wanted, value);
            axis = py::cast<std::string>(parts[0]);
            place.fraction = realFrom(name, parts[1]);
        }
        sound = sound && axis.size() == 1 && axis[0] >= 'x' && axis[0] <= 'z';
        if (!sound)
            throw Error(ErrorCode::InvalidOption,
                        "`" + name + "` " + py::cast<std::string>(py::str(value)) +
                            ": must be an axis and a fraction of the domain, 'z=0.5' or ('z', 0.5)");
        place.axis = axis[0] - 'x';
        return place;
    }
};

void describe(Keywords& keywords, RenderOptions& options) {
    keywords.add("size", options.size, "[pixels] width and height of each model's picture, each 16 to 8192");
    keywords.add("view", options.view,
                 "[world] direction from the model to the camera; None: (1, -1.6, 0.9) where z is up, (1, "
                 "0.9, 1.6) where y is");
    keywords.add("up", options.up,
                 "axis of the world that points up in the picture; None: z. Models of .obj, .gltf and .glb "
                 "files often have 'y'");
    keywords.add("slice", options.slice,
                 "'z=0.5' or ('z', 0.5): draws a slice across an axis, at a fraction of the domain, with a "
                 "scale bar");
    keywords.add("turntable", options.turntable,
                 "pictures of the models as they turn once around, 2 to 3600; 0: one picture");
    keywords.add("captions", options.captions, "a text below each model; (): none");
    keywords.add("columns", options.columns, "pictures side by side, 1 to 64; more models go below");
    keywords.add("sameScale", options.sameScale,
                 "draws several models at one scale; else each fills its picture");
    keywords.add("background", options.background,
                 "'studio' (a soft grey), 'transparent', 'white', 'grey', 'black' or a colour such as "
                 "'#203040'");
    keywords.add("ground", options.ground, "draws a ground with the models' shadow");
    keywords.add(
        "wireframe", options.wireframe,
        "draws the edges of faces: those of LevelSet.source where that was kept, else of the zero level");
    keywords.add("color", options.color,
                 "name of the attribute that holds the colours, or 'none'; '': Cd, color, colour or rgb, if "
                 "there is one");
    keywords.add("density", options.density,
                 "of fog: factor on how much light it absorbs, above 0, at most 1000000");
    keywords.add("samples", options.samples, "rays per pixel at edges, 1 to 64");
    keywords.add("directions", options.directions,
                 "float vectors near the surface, such as AnalogyResult.directions, drawn as streaks; of one "
                 "model only");
}

}  // namespace vdbsynth::python
