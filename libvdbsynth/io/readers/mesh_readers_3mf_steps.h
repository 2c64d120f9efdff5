#pragma once
// What the parts of the 3MF reader share, behind read3mf (mesh_readers.h). Names of XML are compared without
// their prefix, which every writer chooses for itself.
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/io/package/zip_file.h"
#include "libvdbsynth/math/affine.h"

#include <pugixml.hpp>

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

namespace vdbsynth {

/// A placed object: an item of what is built, or a component of another object.
struct ThreemfPlace {
    std::string model;  ///< name of the part of the package, empty: the one that says so
    std::uint32_t object = 0;
    Affine place = kIdentity;
};

enum class ThreemfType { Solid, Support, Other };

struct ThreemfObject {
    ThreemfType type = ThreemfType::Solid;
    std::vector<Vec3d> points;
    std::vector<std::uint32_t> corners;  ///< [triangles x 3]
    std::vector<std::int32_t> colours;   ///< of the corners, in the palette, -1 for none; may be empty
    std::vector<std::int32_t> tints;     ///< of the points, once they are split (splitByColour)
    std::vector<ThreemfPlace> components;
    bool isComponent = false, reached = false;
};

/// One model part of the package.
struct ThreemfModel {
    std::string unit;
    std::map<std::uint32_t, ThreemfObject> objects;
    std::vector<ThreemfPlace> items;
};

/// What was left out, for messages.
struct ThreemfCounts {
    std::size_t textured = 0, mixed = 0, unknownColours = 0, painted = 0, flat = 0, beams = 0, sliced = 0,
                shapeless = 0, supports = 0, others = 0, modifiers = 0, negatives = 0, unbuilt = 0;
};

/// Colours of a file, red first in the four bytes, each once.
class ThreemfPalette {
public:
    std::int32_t add(std::uint32_t rgba);
    const std::vector<std::uint32_t>& colours() const { return mColours; }

private:
    std::vector<std::uint32_t> mColours;
    std::unordered_map<std::uint32_t, std::int32_t> mPlaces;
};

/// What a slicer takes out of the shape: triangles first..last of an object, and components of an object.
struct ThreemfModifiers {
    struct Range {
        std::uint64_t first, last;
        bool negative;
    };
    std::map<std::uint32_t, std::vector<Range>> ranges;
    std::map<std::pair<std::uint32_t, std::uint32_t>, bool> components;  ///< (object, part): is it negative
};

/// A parsed part, in the text that it was read from.
struct ThreemfXml {
    std::string text;
    pugi::xml_document document;
};

/// The key of a part: without a slash at its beginning, in small letters, as names of parts are in any case.
std::string threemfKey(std::string_view name);

/// An opened package. What is wrong with it is an Error BadData that names the file.
class ThreemfPackage {
public:
    /// All are borrowed.
    ThreemfPackage(const std::string& path, const std::string& content, const RunContext& ctx);

    [[noreturn]] void refuse(const std::string& what) const;
    void say(MessageLevel level, const std::string& what) const;
    const RunContext& context() const { return mContext; }

    const std::string& root() const { return mRoot; }
    /// A model part, read when it is first asked for.
    ThreemfModel& model(const std::string& name);
    const std::map<std::string, ThreemfModel>& models() const { return mModels; }

    ThreemfPalette palette;
    ThreemfCounts counts;

private:
    bool parse(const std::string& name, ThreemfXml& xml);
    std::string rootName();

    const std::string& mPath;
    const RunContext& mContext;
    ZipFile mZip;
    std::string mRoot;
    std::map<std::string, ThreemfModel> mModels;
};

/// Properties of one resource, by index: colours in the palette, -1 for none.
struct ThreemfGroup {
    enum class Kind { Colours, Texture, Mixed } kind = Kind::Colours;
    std::vector<std::int32_t> colours;
};
using ThreemfGroups = std::unordered_map<std::uint32_t, ThreemfGroup>;

/// @param resources  element of a model
ThreemfGroups threemfGroups(ThreemfPackage& package, pugi::xml_node resources);
/// @throw Error BadData @param model  element of that name
ThreemfModel threemfModel(ThreemfPackage& package, pugi::xml_node model);
/// Volumes that are no part of the shape, as PrusaSlicer's and Bambu Studio's files list them.
void addThreemfModifiers(pugi::xml_node config, ThreemfModifiers& modifiers);
/// Takes them out of the root model.
void takeOutModifiers(ThreemfPackage& package, const ThreemfModifiers& modifiers, ThreemfModel& root);

/// Name without its prefix.
std::string_view threemfLocal(const char* name);
pugi::xml_node threemfChild(pugi::xml_node node, std::string_view name);
/// Value of an attribute, empty if there is none.
std::string_view threemfText(pugi::xml_node node, std::string_view name);
/// A resource's number. @throw Error BadData (there, and no whole number from 0 to 2^31 - 1)
std::optional<std::uint32_t> threemfWhole(const ThreemfPackage& package, pugi::xml_node node,
                                          std::string_view name);

}  // namespace vdbsynth
