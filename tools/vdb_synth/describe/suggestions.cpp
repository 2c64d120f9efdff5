#include "tools/vdb_synth/describe/suggestions.h"

#include "libvdbsynth/procedural/analogy_pair.h"
#include "libvdbsynth/procedural/exemplar.h"
#include "tools/vdb_synth/command.h"

#include <map>

namespace vdbsynth::cli {
namespace {

using Words = std::vector<std::string>;

const Words kImages{"png", "jpg", "jpeg", "pgm", "ppm", "pnm", "tif", "tiff", "exr"};
const Words kMeshOutputs{"vdb", "obj", "ply", "stl", "off", "glb", "gltf",  "3mf",
                         "png", "exr", "npy", "tif", "vti", "nii", "nii.gz"};

Suggestions files(const Words& extensions) {
    Suggestions made;
    made.extensions = extensions;
    return made;
}

Suggestions words(const Words& list, const Words& extensions = {}) {
    Suggestions made = files(extensions);
    made.words = list;
    return made;
}

Words choicesOf(const Option& option) {
    Words list;
    for (const Choice& choice : option.choices) list.push_back(choice.word);
    return list;
}

Suggestions withExtensions(const Option& option, const Words& otherwise) {
    Suggestions made;
    for (const std::string& extension : option.extensions) made.anyFile = made.anyFile || extension == "*";
    if (!made.anyFile) made.extensions = option.extensions.empty() ? otherwise : option.extensions;
    return made;
}

Words kinds() {
    Words list;
    for (const ExemplarKind& kind : exemplarKinds()) list.push_back(kind.name);
    for (const AnalogyPairKind& kind : analogyPairKinds()) list.push_back(kind.name);
    return list;
}

}  // namespace

const Words& modelExtensions() {
    static const Words all{"vdb", "obj",  "ply",    "stl",   "off",   "mesh", "gltf", "glb",  "3mf",
                           "xyz", "xyzn", "xyzrgb", "pts",   "pwn",   "txt",  "asc",  "csv",  "pcd",
                           "png", "jpg",  "jpeg",   "pgm",   "ppm",   "pnm",  "tif",  "tiff", "exr",
                           "npy", "vti",  "nii",    "sgems", "gslib", "inr"};
    return all;
}

Suggestions valuesOf(const Option& option) {
    switch (option.kind) {
        case Kind::Choice:
        case Kind::AxisChoices:
            return words(choicesOf(option));
        case Kind::Axes:
            return words({"x", "y", "z", "xy", "yz", "xz", "xyz", "none"});
        case Kind::Direction:
            return words({"axis:x", "axis:y", "axis:z", "axis:-x", "axis:-y", "axis:-z", "around:x",
                          "around:y", "around:z", "radial", "curvature"},
                         {"vdb", "csv", "json", "ply"});
        case Kind::Hole:
            // In world units a box stands in its place.
            if (option.unit == Unit::World) return files(modelExtensions());
            [[fallthrough]];
        case Kind::Region:
            return words({"auto"}, modelExtensions());
        case Kind::Model:
        case Kind::ModelOrGrid:
            return files(modelExtensions());
        case Kind::Grid:
            return files({"vdb"});
        case Kind::File:
            return withExtensions(option, {"json"});
        case Kind::Output:
            return withExtensions(option, kMeshOutputs);
        case Kind::Folder: {
            Suggestions made;
            made.folders = true;
            return made;
        }
        default:
            return {};
    }
}

std::vector<Suggestions> inputsOf(const Command& command) {
    static const Suggestions model = files(modelExtensions());
    static const std::map<std::string, std::vector<Suggestions>> all{
        {"mask", {words({"box", "ball", "inside", "range"}), model}},
        {"make", {words(kinds()), files(kMeshOutputs)}},
        {"texture", {model, files(kImages)}},
        {"repeat", {files({"vdb", "ply"}), model}},
        {"batch", {files({"json", "yaml", "yml"})}},
        {"doctor", {}}};
    const auto own = all.find(command.name);
    return own == all.end() ? std::vector<Suggestions>{model} : own->second;
}

}  // namespace vdbsynth::cli
