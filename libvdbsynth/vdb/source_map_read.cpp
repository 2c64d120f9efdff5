// Reads a source map from grids that any program may have written.
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/printable_text.h"
#include "libvdbsynth/vdb/coord.h"
#include "libvdbsynth/vdb/level_set.h"
#include "libvdbsynth/vdb/source_map_grids.h"
#include "libvdbsynth/vdb/source_map_steps.h"
#include "libvdbsynth/vdb/vdb_file.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>

namespace vdbsynth {
namespace {

using namespace mapfile;

constexpr double kFarthest = 1 << 30;          // [voxels] limit of any coordinate
constexpr double kMostVoxels = 2e9;            // limit of the lattice, and of voxels with a source
constexpr std::int64_t kMostHole = 1ll << 33;  // [voxels] of a hole's or a mask's box

std::vector<std::string> splitAt(const std::string& text, char separator) {
    std::vector<std::string> parts;
    std::size_t begin = 0;
    for (std::size_t end; (end = text.find(separator, begin)) != std::string::npos; begin = end + 1)
        parts.push_back(text.substr(begin, end - begin));
    parts.push_back(text.substr(begin));
    return parts;
}

// The metadata of a map's main grid, each entry checked.
class Entries {
public:
    Entries(const std::string& path, const openvdb::GridBase& grid) : mPath(path), mGrid(grid) {}

    bool has(const std::string& name) const {
        return bool(mGrid.getMetadata<openvdb::StringMetadata>(key(name)));
    }
    std::string text(const std::string& name) const {
        const auto meta = mGrid.getMetadata<openvdb::StringMetadata>(key(name));
        if (!meta) throw Error(ErrorCode::BadData, mPath + ": its source map has no " + key(name));
        return meta->value();
    }
    int whole(const std::string& name, int low, int high) const {
        int value = 0;
        if (!parseWhole(text(name), value) || value < low || value > high) refuse(name);
        return value;
    }
    bool flag(const std::string& name) const { return whole(name, 0, 1) == 1; }
    double real(const std::string& name, double low, double high) const {
        double value = 0;
        if (!parseReal(text(name), value) || !(value >= low && value <= high)) refuse(name);
        return value;
    }
    IndexBox box(const std::string& name) const {
        IndexBox box;
        if (!parseBox(text(name), box)) refuse(name);
        return box;
    }
    std::array<bool, 6> faces(const std::string& name) const {
        const std::string given = text(name);
        std::array<bool, 6> faces{};
        if (given.size() != 6 || given.find_first_not_of("01") != std::string::npos) refuse(name);
        for (std::size_t face = 0; face < 6; ++face) faces[face] = given[face] == '1';
        return faces;
    }
    std::vector<double> reals(const std::string& name, const std::string& list, std::size_t count) const {
        std::vector<double> values;
        for (const std::string& part : splitAt(list, ',')) {
            values.push_back(0);
            if (!parseReal(part, values.back())) refuse(name);
        }
        if (values.size() != count) refuse(name);
        return values;
    }
    // A whole number among reals, within the range of int and of boxes.
    int wholeOf(const std::string& name, double value) const {
        if (value != std::floor(value) || std::abs(value) > kFarthest) refuse(name);
        return int(value);
    }
    [[noreturn]] void refuse(const std::string& name) const {
        throw Error(ErrorCode::BadData,
                    mPath + ": its source map has a bad " + key(name) + " \"" + text(name) + "\"");
    }

private:
    const std::string& mPath;
    const openvdb::GridBase& mGrid;
};

GridPtr gridNamed(const std::vector<GridPtr>& grids, const std::string& name) {
    for (const GridPtr& grid : grids)
        if (grid->getName() == name) return grid;
    return nullptr;
}

// Reads scalars, integer or real, of either kind of grid; `missing` without the grid.
using NumberReader = std::function<double(const openvdb::Coord&)>;
using VectorReader = std::function<Vec3d(const openvdb::Coord&)>;

NumberReader numberReader(const std::string& path, const GridPtr& grid, double missing) {
    if (!grid) return [missing](const openvdb::Coord&) { return missing; };
    if (const auto whole = openvdb::gridPtrCast<openvdb::Int32Grid>(grid))
        return [whole, at = whole->getConstAccessor()](const openvdb::Coord& c) {
            return double(at.getValue(c));
        };
    if (const auto real = openvdb::gridPtrCast<openvdb::FloatGrid>(grid))
        return
            [real, at = real->getConstAccessor()](const openvdb::Coord& c) { return double(at.getValue(c)); };
    throw Error(ErrorCode::BadData, path + ": grid \"" + grid->getName() + "\" does not hold scalars");
}

VectorReader vectorReader(const std::string& path, const GridPtr& grid) {
    if (!grid) return [](const openvdb::Coord&) { return Vec3d{}; };
    if (const auto whole = openvdb::gridPtrCast<openvdb::Vec3IGrid>(grid))
        return [whole, at = whole->getConstAccessor()](const openvdb::Coord& c) {
            return vectorOf(at.getValue(c));
        };
    if (const auto real = openvdb::gridPtrCast<openvdb::Vec3SGrid>(grid))
        return [real, at = real->getConstAccessor()](const openvdb::Coord& c) {
            return vectorOf(at.getValue(c));
        };
    throw Error(ErrorCode::BadData, path + ": grid \"" + grid->getName() + "\" does not hold vectors");
}

// Calls body(position) for every active voxel of a grid of vectors. @return false if it has active tiles
bool everyVoxel(const GridPtr& grid, const std::function<void(const openvdb::Coord&)>& body) {
    const auto each = [&](const auto& typed) {
        bool tiles = false;
        for (auto it = typed.cbeginValueOn(); it; ++it)
            if (it.isVoxelValue())
                body(it.getCoord());
            else
                tiles = true;
        return !tiles;
    };
    if (const auto whole = openvdb::gridPtrCast<openvdb::Vec3IGrid>(grid)) return each(*whole);
    if (const auto real = openvdb::gridPtrCast<openvdb::Vec3SGrid>(grid)) return each(*real);
    return false;
}

class Reader {
public:
    Reader(const std::string& path, const std::vector<GridPtr>& grids, const GridPtr& main)
        : mPath(path), mGrids(grids), mMain(main), mEntries(path, *main) {}

    SourceMap read() {
        readMethod();
        readExemplars();
        mMap.targetBox = mEntries.box("target_box");
        mMap.targetDomain = mEntries.box("target_domain");
        mMap.cut = mEntries.faces("cut");
        mMap.band = float(mEntries.real("band", 1.5, 1000));
        mMap.halfWidth = float(mEntries.real("half_width", 1.5, 100));
        mMap.voxelSize = mEntries.real("voxel_size", 1e-30, 1e30);
        if (mEntries.has("moved")) {
            const std::vector<double> moved = mEntries.reals("moved", mEntries.text("moved"), 3);
            mMap.moved = {moved[0], moved[1], moved[2]};
        }
        if (mMap.method != MapMethod::Synthesis) readTarget();
        if (mMap.method == MapMethod::Analogy) {
            readAnalogyEntries();
            readElements();
        } else {
            readBlocks();
        }
        requireSound(mMap, mPath + ": its source map");
        return std::move(mMap);
    }

private:
    [[noreturn]] void refuse(const std::string& what) const {
        throw Error(ErrorCode::BadData, mPath + ": its source map " + what);
    }

    void readMethod() {
        const std::string format = mEntries.text("format");
        if (format != kFormat)
            refuse("is of format " + printableText(format, 20) +
                   ", of another version of vdb_synth; this one reads format " + kFormat +
                   ": create the map again, or use the version that wrote it");
        const std::string method = mEntries.has("method") ? mEntries.text("method") : "synthesis";
        mMap.method = method == "fill"      ? MapMethod::Fill
                      : method == "analogy" ? MapMethod::Analogy
                                            : MapMethod::Synthesis;
        const std::string kernel = mEntries.text("kernel");
        mMap.patches.vote = kernel == kFirstKernel ? PatchVote::First : PatchVote::Blend;
        const bool known = mMap.method == MapMethod::Analogy
                               ? kernel == kNeighbourKernel
                               : kernel == kVoteKernel || kernel == kFirstKernel;
        if (!known || (method != "synthesis" && mMap.method == MapMethod::Synthesis) ||
            (mMap.method == MapMethod::Analogy) != (mMain->getName() == "source"))
            refuse("has a method or kernel that this version of vdb_synth does not know; create it again");
    }

    void readExemplars() {
        const int count = mEntries.has("exemplars") ? mEntries.whole("exemplars", 1, 64) : 1;
        for (std::size_t e = 0; e < std::size_t(count); ++e) {
            MappedExemplar exemplar;
            exemplar.box = mEntries.box(numbered("exemplar_box", e));
            exemplar.domain = mEntries.box(numbered("exemplar_domain", e));
            exemplar.hash = mEntries.text(numbered("exemplar_hash", e));
            if (mMap.method != MapMethod::Synthesis)
                exemplar.cut = mEntries.faces(numbered("exemplar_cut", e));
            const std::string transform = numbered("exemplar_transform", e);
            if (mEntries.has(transform)) {
                const std::vector<double> numbers =
                    mEntries.reals(transform, mEntries.text(transform), exemplar.transform.size());
                std::copy(numbers.begin(), numbers.end(), exemplar.transform.begin());
            }
            mMap.exemplars.push_back(exemplar);
        }
    }

    void readTarget() {
        mMap.target.hash = mEntries.text("target_hash");
        mMap.target.voxelSize = mEntries.real("target_voxel_size", 1e-30, 1e30);
        mMap.target.domainRecorded = mEntries.flag("target_domain_recorded");
        if (mMap.method != MapMethod::Fill) return;
        mMap.hole.fromSelf = mEntries.flag("from_self");
        mMap.hole.guessed = mEntries.flag("guessed");
        mMap.hole.distance = fieldOf("source_hole", -100, 100, mMap.hole.corner);
    }

    void readAnalogyEntries() {
        MappedAnalogy& analogy = mMap.analogy;
        analogy.scale = mEntries.real("scale", 0.25, 4);
        analogy.strength = float(mEntries.real("strength", 0, 1));
        for (const std::string& part : splitAt(mEntries.text("depths"), ';')) {
            const std::vector<double> run = mEntries.reals("depths", part, 2);
            analogy.depths.push_back({mEntries.wholeOf("depths", run[0]), run[1] == 1});
        }
        if (!gridNamed(mGrids, "source_strength")) return;
        Index3 corner;
        analogy.weight = fieldOf("source_strength", 0, 1, corner);
        if (corner != mMap.targetBox.min || analogy.weight.box().size() != mMap.targetBox.size())
            refuse("has a grid \"source_strength\" of another size than its target_box");
    }

    // A grid whose active box is full, as a field that begins at 0.
    BrickField fieldOf(const std::string& name, float low, float high, Index3& corner) const {
        const auto grid = openvdb::gridPtrCast<openvdb::FloatGrid>(gridNamed(mGrids, name));
        if (!grid) refuse("has no grid \"" + name + "\" of floats");
        const openvdb::CoordBBox active = grid->evalActiveVoxelBoundingBox();
        if (active.empty() || IndexBox(fromBBox(active)).volume() > kMostHole)
            refuse("has a bad grid \"" + name + "\"");
        corner = fromBBox(active).min;
        // Accessors are not shared between threads; this field is small compared with a synthesis.
        const auto values = grid->getConstAccessor();
        RunContext alone;
        alone.threads = 1;
        bool good = true;
        BrickField field =
            BrickField::fromVoxels(IndexBox::fromSize(fromBBox(active).size()), alone, [&](const Index3& p) {
                const float value = values.getValue(toCoord(corner + p));
                good = good && value >= low && value <= high;
                return value;
            });
        if (!good) refuse("has values out of range in grid \"" + name + "\"");
        return field;
    }

    void readElements() {
        const VectorReader place = vectorReader(mPath, mMain);
        const VectorReader offset = vectorReader(mPath, gridNamed(mGrids, "source_offset")),
                           rotation = vectorReader(mPath, gridNamed(mGrids, "source_rotation"));
        const NumberReader exemplar = numberReader(mPath, gridNamed(mGrids, "exemplar"), 0),
                           scale = numberReader(mPath, gridNamed(mGrids, "source_scale"), 1);
        if (double(mMain->activeVoxelCount()) > kMostVoxels) refuse("has too many voxels");
        const auto within = [](const Vec3d& v, double most) { return length(v) <= most; };  // false for NaN
        const bool voxels = everyVoxel(mMain, [&](const openvdb::Coord& at) {
            Source source;
            const Vec3d from = place(at), by = offset(at), rotationVector = rotation(at);
            const double number = exemplar(at), size = scale(at);
            if (!within(from, kFarthest) || !within(by, 2) || !within(rotationVector, 100) ||
                !(size > 0 && size < 100) || !(number >= 0 && number < 64 && number == std::floor(number)))
                refuse("has a bad source at " + std::to_string(at.x()) + "," + std::to_string(at.y()) + "," +
                       std::to_string(at.z()));
            source.exemplar = std::int32_t(number);
            source.position = from + by;
            source.rotation = cast<float>(rotationVector);
            source.scale = float(size);
            mMap.elements.add(fromCoord(at), source);
        });
        if (!voxels) refuse("has tiles instead of single voxels");
    }

    void readBlocks() {
        PatchMap& patches = mMap.patches;
        patches.block = mEntries.whole("patch", 1, 65536);
        patches.stride = mEntries.whole("stride", 1, patches.block);
        mMap.matched = mEntries.whole("matched", 1, 65536);
        mMap.draft = mEntries.flag("draft");
        const std::vector<double> overhang = mEntries.reals("overhang", mEntries.text("overhang"), 3);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (overhang[axis] < 0 || overhang[axis] > 65536) mEntries.refuse("overhang");
            patches.overhang[int(axis)] = mEntries.wholeOf("overhang", overhang[axis]);
        }
        if (mEntries.has("variants")) readVariants();
        patches.target = mMap.targetBox.size();
        const Index3 lattice = patches.lattice();
        const double blocks = double(lattice.x) * double(lattice.y) * double(lattice.z);
        if (double(mMain->activeVoxelCount()) != blocks || blocks > kMostVoxels)
            refuse("has " + std::to_string(mMain->activeVoxelCount()) + " blocks instead of " +
                   roundedText(blocks, 12));
        patches.allocate();
        readSources(lattice);
    }

    void readVariants() {
        const std::string text = mEntries.text("variants");
        for (const std::string& part : splitAt(text, ';')) {
            if (part.empty()) continue;
            const std::vector<double> n = mEntries.reals("variants", part, 8);
            ExemplarVariant variant;
            variant.exemplar = mEntries.wholeOf("variants", n[0]);
            variant.rotation = {n[1], n[2], n[3]};
            variant.scale = n[4];
            variant.size = {mEntries.wholeOf("variants", n[5]), mEntries.wholeOf("variants", n[6]),
                            mEntries.wholeOf("variants", n[7])};
            mMap.variants.push_back(variant);
        }
        if (mMap.variants.empty() || mMap.variants.size() > 4096) mEntries.refuse("variants");
    }

    void readSources(const Index3& lattice) {
        const std::size_t count = mMap.variants.empty() ? mMap.exemplars.size() : mMap.variants.size();
        if (count > 1 && !gridNamed(mGrids, "vote_exemplar")) refuse("has no grid \"vote_exemplar\"");
        if (!gridNamed(mGrids, "vote_weight")) refuse("has no grid \"vote_weight\"");
        const VectorReader place = vectorReader(mPath, mMain);
        const NumberReader number =
            numberReader(mPath, count > 1 ? gridNamed(mGrids, "vote_exemplar") : nullptr, 0);
        const NumberReader weight = numberReader(mPath, gridNamed(mGrids, "vote_weight"), 1);
        PatchMap& patches = mMap.patches;
        patches.weight.resize(patches.source.size());
        const bool voxels = everyVoxel(mMain, [&](const openvdb::Coord& at) {
            const Index3 l = fromCoord(at);
            if (!IndexBox::fromSize(lattice).contains(l)) refuse("has a block outside its lattice");
            const std::size_t i = patches.index(l);
            const double exemplar = number(at);
            if (!(exemplar >= 0 && exemplar < double(count) && exemplar == std::floor(exemplar)))
                refuse("names an exemplar that it does not have");
            patches.exemplar[i] = std::int32_t(exemplar);
            patches.weight[i] = float(weight(at));
            const Vec3d from = place(at);
            if (!(length(from) <= kFarthest)) refuse("points outside the exemplar");
            const Index3 corner =
                mMap.variants.empty() ? mMap.exemplars[std::size_t(exemplar)].box.min : Index3{0, 0, 0};
            patches.source[i] =
                Index3{int(std::lround(from.x)), int(std::lround(from.y)), int(std::lround(from.z))} - corner;
        });
        if (!voxels) refuse("has tiles instead of single blocks");
    }

    const std::string& mPath;
    const std::vector<GridPtr>& mGrids;
    GridPtr mMain;
    Entries mEntries;
    SourceMap mMap;
};

}  // namespace

SourceMap sourceMapFrom(const std::string& path, const std::vector<GridPtr>& grids, const RunContext& ctx) {
    throwIfCancelled(ctx);
    requireGrids(grids);
    GridPtr main = gridNamed(grids, "vote_source");
    if (!main) main = gridNamed(grids, "source");
    if (!main)
        throw Error(ErrorCode::BadData,
                    path + ": holds no source map; synth and analogy write one on request");
    return Reader(path, grids, main).read();
}

SourceMap readSourceMap(const std::string& path, const RunContext& ctx) {
    return sourceMapFrom(path, readVdbGrids(path, ctx), ctx);
}

std::vector<MappedVoxel> strongestSourcesIn(const std::vector<GridPtr>& grids) {
    requireGrids(grids);
    std::vector<MappedVoxel> voxels;
    const GridPtr source = gridNamed(grids, "source");
    if (!source) return voxels;
    const VectorReader place = vectorReader("", source);
    const NumberReader exemplar = numberReader("", gridNamed(grids, "exemplar"), 0);
    everyVoxel(source, [&](const openvdb::Coord& at) {
        const Vec3d from = place(at);
        const double number = exemplar(at);
        if (!(length(from) <= kFarthest) || !(number >= 0 && number < kFarthest)) return;
        Source strongest;
        strongest.position = from;
        strongest.exemplar = std::int32_t(number);
        voxels.push_back({fromCoord(at), strongest});
    });
    return voxels;
}

bool hasSourcesIn(const std::vector<GridPtr>& grids, const openvdb::FloatGrid& like) {
    requireGrids(grids);
    const GridPtr source = gridNamed(grids, "source");
    if (!source || !(source->isType<openvdb::Vec3IGrid>() || source->isType<openvdb::Vec3SGrid>()))
        return false;
    const auto matrix = [](const openvdb::GridBase& grid) {
        return grid.transform().baseMap()->getAffineMap()->getMat4();
    };
    const openvdb::Mat4d difference = matrix(*source) - matrix(like);
    const double voxel = voxelSizeOf(like);
    for (int i = 0; i < 16; ++i)
        if (std::abs(difference.asPointer()[i]) > 1e-4 * voxel) return false;
    return true;
}

}  // namespace vdbsynth
