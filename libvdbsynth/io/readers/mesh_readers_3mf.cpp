// The meshes of 3MF files: objects placed as the build says, components within components.
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/printable_text.h"
#include "libvdbsynth/io/readers/mesh_readers.h"
#include "libvdbsynth/io/readers/mesh_readers_3mf_steps.h"

#include <algorithm>

namespace vdbsynth {
namespace {

// A point with corners of several colours becomes one point for each; flat triangles are left out.
void splitByColour(ThreemfPackage& package, ThreemfObject& object) {
    std::size_t next = 0;
    object.tints.assign(object.points.size(), -1);
    std::map<std::pair<std::uint32_t, std::int32_t>, std::uint32_t> split;
    for (std::size_t t = 0; t + 2 < object.corners.size(); t += 3) {
        const std::uint32_t* v = &object.corners[t];
        if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) {
            ++package.counts.flat;
            continue;
        }
        for (std::size_t k = 0; k < 3; ++k) {
            std::uint32_t point = object.corners[t + k];
            const std::int32_t colour = object.colours.empty() ? -1 : object.colours[t + k];
            if (colour >= 0 && object.tints[point] < 0) object.tints[point] = colour;
            if (colour >= 0 && object.tints[point] != colour) {
                const auto [at, fresh] =
                    split.try_emplace({point, colour}, std::uint32_t(object.points.size()));
                if (fresh) {
                    object.points.push_back(Vec3d(object.points[point]));
                    object.tints.push_back(colour);
                }
                point = at->second;
            }
            object.corners[next++] = point;
        }
    }
    object.corners.resize(next);
    object.colours = {};
}

class Scene {
public:
    explicit Scene(ThreemfPackage& package) : mPackage(package) {}

    MeshContent read() {
        ThreemfModel& root = mPackage.model(mPackage.root());
        std::vector<ThreemfPlace> items = root.items;
        if (items.empty()) {
            for (auto& [id, object] : root.objects)
                for (const ThreemfPlace& part : object.components)
                    if (part.model.empty() && root.objects.count(part.object))
                        root.objects[part.object].isComponent = true;
            for (const auto& [id, object] : root.objects)
                if (!object.isComponent) items.push_back({"", id, kIdentity});
            if (!items.empty())
                mPackage.say(MessageLevel::Note, "builds no object; all its objects are read");
        }
        requireRoom(items);
        for (const ThreemfPlace& item : items) place(item, mPackage.root(), kIdentity);
        return finished();
    }

    std::size_t parts() const { return mParts; }

private:
    // What an object and all below it amount to.
    struct Total {
        double points = 0, triangles = 0, places = 1;
        bool open = false, known = false;
    };
    using Key = std::pair<std::string, std::uint32_t>;

    // The name is the key of its model, so equal parts are equal keys.
    Key keyOf(const ThreemfPlace& placed, const std::string& model) {
        return {placed.model.empty() ? model : threemfKey(placed.model), placed.object};
    }

    ThreemfObject& objectOf(const Key& key) {
        ThreemfModel& model = mPackage.model(key.first);
        const auto found = model.objects.find(key.second);
        if (found == model.objects.end())
            mPackage.refuse("builds object " + std::to_string(key.second) + " of " +
                            printableText(key.first, 200) + ", which does not exist");
        return found->second;
    }

    // Before anything is placed: a few kilobytes can name a component a billion times.
    const Total& totalOf(const Key& key, int depth) {
        constexpr int kDeepest = 100;
        Total& total = mTotals[key];
        if (total.known) return total;
        if (total.open) mPackage.refuse("object " + std::to_string(key.second) + " is a component of itself");
        if (depth > kDeepest) mPackage.refuse("its components are nested over 100 deep");
        total.open = true;
        ThreemfObject& object = objectOf(key);
        object.reached = true;
        if (isLeftOut(object)) {
            ++(object.type == ThreemfType::Support ? mPackage.counts.supports : mPackage.counts.others);
        } else {
            splitByColour(mPackage, object);
            total.points = double(object.points.size());
            total.triangles = double(object.corners.size()) / 3;
            for (const ThreemfPlace& part : object.components)
                add(total, totalOf(keyOf(part, key.first), depth + 1));
        }
        total.open = false;
        total.known = true;
        return total;
    }

    static bool isLeftOut(const ThreemfObject& object) { return object.type != ThreemfType::Solid; }

    static void add(Total& sum, const Total& part) {
        sum.points += part.points;
        sum.triangles += part.triangles;
        sum.places += part.places;
    }

    void requireRoom(const std::vector<ThreemfPlace>& items) {
        Total all;
        for (const ThreemfPlace& item : items) add(all, totalOf(keyOf(item, mPackage.root()), 0));
        if (all.points > 4294967294.0) mPackage.refuse("has over four billion vertices");
        if (all.places > 1e7) mPackage.refuse("places its objects over ten million times");
        requireMemory(mPackage.context(), all.points * 40 + all.triangles * 16, "the meshes of a 3MF file",
                      "export a part of it");
        mPoints.reserve(std::size_t(all.points));
        mTints.reserve(std::size_t(all.points));
    }

    void place(const ThreemfPlace& placed, const std::string& model, const Affine& above) {
        const Key key = keyOf(placed, model);
        const ThreemfObject& object = objectOf(key);
        if (isLeftOut(object)) return;
        const Affine matrix = multiplied(above, placed.place);
        if (!object.corners.empty()) append(object, matrix);
        for (const ThreemfPlace& part : object.components) place(part, key.first, matrix);
    }

    void append(const ThreemfObject& object, const Affine& matrix) {
        throwIfCancelled(mPackage.context());
        ++mParts;
        const std::uint32_t first = std::uint32_t(mPoints.size());
        const bool mirrored = determinant(matrix) < 0;
        for (const Vec3d& p : object.points) mPoints.push_back(transformed(matrix, p));
        mTints.insert(mTints.end(), object.tints.begin(), object.tints.end());
        for (std::size_t t = 0; t < object.corners.size(); t += 3) {
            std::uint32_t v[3] = {object.corners[t] + first, object.corners[t + 1] + first,
                                  object.corners[t + 2] + first};
            if (mirrored) std::swap(v[0], v[1]);
            mPolygons.add(v, 3);
        }
    }

    MeshContent finished() {
        MeshContent content;
        const std::vector<std::uint32_t>& palette = mPackage.palette.colours();
        const bool coloured =
            std::any_of(mTints.begin(), mTints.end(), [](std::int32_t c) { return c >= 0; });
        if (coloured) {
            Attribute colour{"Cd", 3, {}}, alpha{"Alpha", 1, {}};
            bool clear = false;
            for (std::int32_t tint : mTints) {
                const std::uint32_t rgba = tint < 0 ? 0xffffffff : palette[std::size_t(tint)];
                for (int shift : {24, 16, 8}) colour.values.push_back(float(rgba >> shift & 0xff) / 255);
                alpha.values.push_back(float(rgba & 0xff) / 255);
                clear = clear || (rgba & 0xff) != 0xff;
            }
            content.attributes.push_back(std::move(colour));
            if (clear) content.attributes.push_back(std::move(alpha));
        }
        content.points = std::move(mPoints);
        content.polygons = std::move(mPolygons);
        return content;
    }

    ThreemfPackage& mPackage;
    std::map<Key, Total> mTotals;
    std::vector<Vec3d> mPoints;
    std::vector<std::int32_t> mTints;
    PolygonList mPolygons;
    std::size_t mParts = 0;
};

void sayUnit(const ThreemfPackage& package, const std::string& unit) {
    static const std::pair<const char*, const char*> units[] = {
        {"micron", "0.001"}, {"centimeter", "10"}, {"inch", "25.4"}, {"foot", "304.8"}, {"meter", "1000"}};
    const auto known = std::find_if(std::begin(units), std::end(units),
                                    [&](const auto& entry) { return unit == entry.first; });
    if (known != std::end(units))
        package.say(MessageLevel::Note, "its unit is " + unit +
                                            ", and coordinates stay as they are; `unitScale` " +
                                            known->second + " reads them as millimetres");
    else if (unit.empty() || unit == "millimeter")
        package.say(MessageLevel::Detail, "its unit is millimeter");
    else
        package.say(MessageLevel::Warning,
                    "its unit is unknown (" + printableText(unit, 40) + "); coordinates stay as they are");
}

void sayCounts(const ThreemfPackage& package) {
    const ThreemfCounts& counts = package.counts;
    const auto say = [&](std::size_t count, const char* what, const char* rest,
                         MessageLevel level = MessageLevel::Note) {
        if (count > 0) package.say(level, countText(count, what) + rest);
    };
    say(counts.supports, "object", " of support left out");
    say(counts.others, "object", " of no printed type left out");
    say(counts.modifiers, "modifier", " of a slicer left out");
    say(counts.negatives, "negative volume",
        " of a slicer left out, not subtracted; subtract it there and export the result",
        MessageLevel::Warning);
    say(counts.shapeless, "object", " of another shape than triangles left out");
    say(counts.beams, "beam", " of lattices left out; export them as a mesh");
    say(counts.sliced, "object", " with slices; their meshes are read");
    say(counts.unbuilt, "object", " that nothing places left out");
    say(counts.flat, "triangle", " with two corners at one vertex left out");
    say(counts.textured, "triangle", " with a picture; pictures are not read");
    say(counts.mixed, "triangle", " with mixed materials, of which the first colour is kept");
    say(counts.unknownColours, "triangle", " with a colour that does not exist, left without");
    say(counts.painted, "triangle", " painted in a slicer; its colours are left out");
}

}  // namespace

MeshContent read3mf(const std::string& path, const std::string& content, const RunContext& ctx) {
    ThreemfPackage package(path, content, ctx);
    Scene scene(package);
    MeshContent mesh = scene.read();
    for (const auto& [name, model] : package.models())
        for (const auto& [id, object] : model.objects)
            package.counts.unbuilt +=
                !object.reached && !object.corners.empty() && object.type == ThreemfType::Solid;
    sayUnit(package, package.model(package.root()).unit);
    sayCounts(package);
    if (scene.parts() > 1)
        package.say(MessageLevel::Detail, "holds " + std::to_string(scene.parts()) + " placed objects");
    return mesh;
}

}  // namespace vdbsynth
