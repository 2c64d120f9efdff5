// The source map as grids of a VDB file, and back.
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/pipeline/synth.h"
#include "libvdbsynth/vdb/coord.h"
#include "libvdbsynth/vdb/vdb_file.h"

#include <openvdb/openvdb.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <sstream>

namespace vdbsynth {
namespace {

std::string key(const char* name) {
    return std::string("vdbsynth:map:") + name;
}

void putText(openvdb::GridBase& grid, const char* name, const std::string& value) {
    grid.insertMeta(key(name), openvdb::StringMetadata(value));
}

std::string getText(const std::string& path, const openvdb::GridBase& grid, const char* name) {
    const auto meta = grid.getMetadata<openvdb::StringMetadata>(key(name));
    if (!meta) throw Error(ErrorCode::BadData, path + ": its source map has no " + key(name));
    return meta->value();
}

int getWhole(const std::string& path, const openvdb::GridBase& grid, const char* name, int low, int high) {
    const std::string text = getText(path, grid, name);
    char* end = nullptr;
    const long value = std::strtol(text.c_str(), &end, 10);
    if (*end || text.empty() || value < low || value > high)
        throw Error(ErrorCode::BadData,
                    path + ": its source map has a bad " + key(name) + " \"" + text + "\"");
    return int(value);
}

double getReal(const std::string& path, const openvdb::GridBase& grid, const char* name, double low,
               double high) {
    const std::string text = getText(path, grid, name);
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (*end || text.empty() || !(value >= low && value <= high))
        throw Error(ErrorCode::BadData,
                    path + ": its source map has a bad " + key(name) + " \"" + text + "\"");
    return value;
}

IndexBox getBox(const std::string& path, const openvdb::GridBase& grid, const char* name) {
    IndexBox box;
    const std::string text = getText(path, grid, name);
    if (!parseBox(text, box))
        throw Error(ErrorCode::BadData,
                    path + ": its source map has a bad " + key(name) + " \"" + text + "\"");
    return box;
}

std::string exactText(double value) {
    char text[64];
    std::snprintf(text, sizeof text, "%.17g", value);
    return text;
}

constexpr const char* kFirstKernel = "first";

// The first exemplar's entries have no number.
std::string numbered(const char* name, std::size_t e) {
    return e == 0 ? name : std::string(name) + "_" + std::to_string(e);
}

std::string textOf(const std::vector<ExemplarVariant>& variants) {
    std::string text;
    for (const ExemplarVariant& v : variants)
        text += std::to_string(v.exemplar) + "," + exactText(v.rotation.x) + "," + exactText(v.rotation.y) +
                "," + exactText(v.rotation.z) + "," + exactText(v.scale) + "," + std::to_string(v.size.x) +
                "," + std::to_string(v.size.y) + "," + std::to_string(v.size.z) + ";";
    return text;
}

bool parseVariants(const std::string& text, std::size_t exemplars, std::vector<ExemplarVariant>& variants) {
    std::istringstream stream(text);
    for (std::string part; std::getline(stream, part, ';');) {
        ExemplarVariant v;
        int end = 0;
        if (std::sscanf(part.c_str(), "%d,%lf,%lf,%lf,%lf,%d,%d,%d%n", &v.exemplar, &v.rotation.x,
                        &v.rotation.y, &v.rotation.z, &v.scale, &v.size.x, &v.size.y, &v.size.z, &end) != 8 ||
            std::size_t(end) != part.size() || v.exemplar < 0 || std::size_t(v.exemplar) >= exemplars ||
            !(length(v.rotation) <= 100) || !(v.scale >= 0.2 && v.scale <= 5) ||
            std::min({v.size.x, v.size.y, v.size.z}) < 1 || std::max({v.size.x, v.size.y, v.size.z}) > 65536)
            return false;
        variants.push_back(v);
    }
    return variants.size() <= 4096;
}

// Which exemplar or variant each patch is from; the first where the file does not say.
void readNumbers(const std::string& path, SourceMap& map, const RunContext& ctx) {
    const std::size_t count = map.variants.empty() ? map.exemplars.size() : map.variants.size();
    if (count == 1) return;
    const auto numbers = openvdb::gridPtrCast<openvdb::Int32Grid>(readVdbGrid(path, "vote_exemplar", ctx));
    if (!numbers) throw Error(ErrorCode::BadData, path + ": grid \"vote_exemplar\" is not of whole numbers");
    const auto accessor = numbers->getConstAccessor();
    for (std::size_t i = 0; i < map.patches.source.size(); ++i) {
        const Index3 l = map.patches.place(i);
        const int number = accessor.getValue(openvdb::Coord(l.x, l.y, l.z));
        if (number < 0 || std::size_t(number) >= count)
            throw Error(ErrorCode::BadData,
                        path + ": its source map names an exemplar that it does not have");
        map.patches.exemplar[i] = number;
    }
}

// Where the sources of a number begin in what it counts, as the file writes them, and the box they lie in.
IndexBox roomOf(const SourceMap& map, std::int32_t number) {
    return map.variants.empty() ? map.exemplars[std::size_t(number)].box
                                : IndexBox::fromSize(map.variants[std::size_t(number)].size);
}

void readExemplars(const std::string& path, const openvdb::GridBase& grid, SourceMap& map) {
    const int count = grid.getMetadata<openvdb::StringMetadata>(key("exemplars"))
                          ? getWhole(path, grid, "exemplars", 1, 64)
                          : 1;
    for (std::size_t e = 0; e < std::size_t(count); ++e) {
        MappedExemplar exemplar;
        exemplar.box = getBox(path, grid, numbered("exemplar_box", e).c_str());
        exemplar.domain = getBox(path, grid, numbered("exemplar_domain", e).c_str());
        exemplar.hash = getText(path, grid, numbered("exemplar_hash", e).c_str());
        map.exemplars.push_back(exemplar);
    }
    if (grid.getMetadata<openvdb::StringMetadata>(key("variants")) &&
        !parseVariants(getText(path, grid, "variants"), map.exemplars.size(), map.variants))
        throw Error(ErrorCode::BadData, path + ": its source map has a bad " + key("variants"));
}

void readWeights(const std::string& path, PatchMap& patches, const RunContext& ctx) {
    const auto weights = openvdb::gridPtrCast<openvdb::FloatGrid>(readVdbGrid(path, "vote_weight", ctx));
    if (!weights) throw Error(ErrorCode::BadData, path + ": grid \"vote_weight\" is not of floats");
    patches.weight.resize(patches.source.size());
    const auto accessor = weights->getConstAccessor();
    for (std::size_t i = 0; i < patches.source.size(); ++i) {
        const Index3 l = patches.place(i);
        const float weight = accessor.getValue(openvdb::Coord(l.x, l.y, l.z));
        if (!(weight > 0 && weight <= 1))
            throw Error(ErrorCode::BadData, path +
                                                ": its source map has a vote weight that is not over 0 and "
                                                "at most 1");
        patches.weight[i] = weight;
    }
}

}  // namespace

std::vector<GridPtr> sourceMapGrids(const SourceMap& map, const openvdb::FloatGrid& result,
                                    const RunContext& ctx) {
    Stage stage(ctx, "source map", 1);
    auto votes = openvdb::Vec3IGrid::create(openvdb::Vec3i(0));
    votes->setName("vote_source");
    auto weights = openvdb::FloatGrid::create(0.f);
    weights->setName("vote_weight");
    auto voteAccessor = votes->getAccessor();
    auto weightAccessor = weights->getAccessor();
    const Index3 lattice = map.patches.lattice();
    auto numbers = openvdb::Int32Grid::create(0);
    numbers->setName("vote_exemplar");
    auto numberAccessor = numbers->getAccessor();
    for (int a = 0; a < lattice.x; ++a)
        for (int b = 0; b < lattice.y; ++b)
            for (int c = 0; c < lattice.z; ++c) {
                const std::size_t at = map.patches.index({a, b, c});
                const std::int32_t number = map.patches.exemplar[at];
                numberAccessor.setValueOn(openvdb::Coord(a, b, c), number);
                const Index3 source = map.patches.source[at] + roomOf(map, number).min;
                voteAccessor.setValueOn(openvdb::Coord(a, b, c),
                                        openvdb::Vec3i(source.x, source.y, source.z));
                weightAccessor.setValueOn(openvdb::Coord(a, b, c),
                                          map.patches.weight.empty() ? 1.f : map.patches.weight[at]);
            }
    putText(*votes, "format", "2");
    putText(*votes, "patch", std::to_string(map.patches.block));
    putText(*votes, "stride", std::to_string(map.patches.stride));
    putText(*votes, "matched", std::to_string(map.matched));
    putText(*votes, "overhang",
            std::to_string(map.patches.overhang.x) + "," + std::to_string(map.patches.overhang.y) + "," +
                std::to_string(map.patches.overhang.z));
    putText(*votes, "kernel", map.patches.vote == PatchVote::First ? kFirstKernel : kVoteKernel);
    std::string cut;
    for (bool face : map.cut) cut += face ? '1' : '0';
    putText(*votes, "cut", cut);
    putText(*votes, "draft", map.draft ? "1" : "0");
    putText(*votes, "target_box", boxText(map.targetBox));
    putText(*votes, "target_domain", boxText(map.targetDomain));
    putText(*votes, "band", exactText(double(map.band)));
    putText(*votes, "half_width", exactText(double(map.halfWidth)));
    putText(*votes, "voxel_size", exactText(map.voxelSize));
    if (map.exemplars.size() > 1) putText(*votes, "exemplars", std::to_string(map.exemplars.size()));
    for (std::size_t e = 0; e < map.exemplars.size(); ++e) {
        putText(*votes, numbered("exemplar_box", e).c_str(), boxText(map.exemplars[e].box));
        putText(*votes, numbered("exemplar_domain", e).c_str(), boxText(map.exemplars[e].domain));
        putText(*votes, numbered("exemplar_hash", e).c_str(), map.exemplars[e].hash);
    }
    if (!map.variants.empty()) putText(*votes, "variants", textOf(map.variants));
    // A target keeps the exemplar's transform.
    const openvdb::Mat4d matrix = result.transform().baseMap()->getAffineMap()->getMat4();
    std::string transform;
    for (int i = 0; i < 16; ++i) transform += (i ? "," : "") + exactText(matrix.asPointer()[i]);
    putText(*votes, "exemplar_transform", transform);

    auto source = openvdb::Vec3IGrid::create(openvdb::Vec3i(0));
    source->setName("source");
    source->setTransform(result.transform().copy());
    auto exemplar = openvdb::Int32Grid::create(0);
    exemplar->setName("exemplar");
    exemplar->setTransform(result.transform().copy());
    auto sourceAccessor = source->getAccessor();
    auto exemplarAccessor = exemplar->getAccessor();
    auto rotation = openvdb::Vec3SGrid::create(openvdb::Vec3f(0));
    rotation->setName("source_rotation");
    rotation->setTransform(result.transform().copy());
    auto rotationAccessor = rotation->getAccessor();
    auto scale = openvdb::FloatGrid::create(1.f);
    scale->setName("source_scale");
    scale->setTransform(result.transform().copy());
    auto scaleAccessor = scale->getAccessor();
    for (const auto& [to, from] : strongestSources(map, result, ctx)) {
        const openvdb::Coord at = toCoord(to);
        sourceAccessor.setValueOn(at, openvdb::Vec3i(from.voxel.x, from.voxel.y, from.voxel.z));
        exemplarAccessor.setValueOn(at, int(from.exemplar));
        if (!from.variant) continue;
        const Vec3d& turn = from.variant->rotation;
        rotationAccessor.setValueOn(at, openvdb::Vec3f(float(turn.x), float(turn.y), float(turn.z)));
        scaleAccessor.setValueOn(at, float(from.variant->scale));
    }
    stage.advance();
    std::vector<GridPtr> grids{source, exemplar, votes, weights};
    if (map.exemplars.size() > 1 || !map.variants.empty()) grids.push_back(numbers);
    if (!map.variants.empty()) {
        grids.push_back(rotation);
        grids.push_back(scale);
    }
    return grids;
}

SourceMap readSourceMap(const std::string& path, const RunContext& ctx) {
    const GridPtr grid = readVdbGrid(path, "vote_source", ctx);
    const auto votes = openvdb::gridPtrCast<openvdb::Vec3IGrid>(grid);
    if (!votes) throw Error(ErrorCode::BadData, path + ": grid \"vote_source\" is not a source map");
    SourceMap map;
    const std::string kernel = getText(path, *votes, "kernel");
    map.patches.vote = kernel == kFirstKernel ? PatchVote::First : PatchVote::Blend;
    if ((kernel != kVoteKernel && kernel != kFirstKernel) || getText(path, *votes, "format") != "2")
        throw Error(ErrorCode::BadData,
                    path + ": its source map was written by another version of vdb_synth; make it again");
    map.patches.block = getWhole(path, *votes, "patch", 1, 65536);
    map.patches.stride = getWhole(path, *votes, "stride", 1, map.patches.block);
    map.matched = getWhole(path, *votes, "matched", 1, 65536);
    Index3& overhang = map.patches.overhang;
    const std::string overhangText = getText(path, *votes, "overhang");
    if (std::sscanf(overhangText.c_str(), "%d,%d,%d", &overhang.x, &overhang.y, &overhang.z) != 3 ||
        std::min({overhang.x, overhang.y, overhang.z}) < 0 ||
        std::max({overhang.x, overhang.y, overhang.z}) > 65536)
        throw Error(ErrorCode::BadData, path + ": its source map has a bad " + key("overhang"));
    const std::string cut = getText(path, *votes, "cut");
    if (cut.size() != 6) throw Error(ErrorCode::BadData, path + ": its source map has a bad " + key("cut"));
    for (std::size_t face = 0; face < 6; ++face) map.cut[face] = cut[face] == '1';
    map.draft = getWhole(path, *votes, "draft", 0, 1) == 1;
    readExemplars(path, *votes, map);
    map.targetBox = getBox(path, *votes, "target_box");
    map.targetDomain = getBox(path, *votes, "target_domain");
    map.band = float(getReal(path, *votes, "band", 1.5, 130));
    map.halfWidth = float(getReal(path, *votes, "half_width", 1.5, 100));
    map.voxelSize = getReal(path, *votes, "voxel_size", 1e-30, 1e30);
    if (!map.targetBox.contains(map.targetDomain))
        throw Error(ErrorCode::BadData, path + ": its source map's domain lies outside its box");
    map.patches.target = map.targetBox.size();
    const Index3 lattice = map.patches.lattice();
    const std::uint64_t blocks =
        std::uint64_t(lattice.x) * std::uint64_t(lattice.y) * std::uint64_t(lattice.z);
    if (votes->activeVoxelCount() != blocks)
        throw Error(ErrorCode::BadData, path + ": its source map has " +
                                            std::to_string(votes->activeVoxelCount()) + " blocks where " +
                                            std::to_string(blocks) + " belong");
    map.patches.allocate();
    readNumbers(path, map, ctx);
    for (auto it = votes->cbeginValueOn(); it; ++it) {
        const Index3 l = fromCoord(it.getCoord());
        const Index3 source{(*it).x(), (*it).y(), (*it).z()};
        const bool inside = it.isVoxelValue() && l.x >= 0 && l.y >= 0 && l.z >= 0 && l.x < lattice.x &&
                            l.y < lattice.y && l.z < lattice.z;
        const std::size_t at = inside ? map.patches.index(l) : 0;
        const IndexBox room = roomOf(map, map.patches.exemplar[at]);
        if (!inside || !room.contains(source))
            throw Error(ErrorCode::BadData, path + ": its source map points outside the exemplar");
        map.patches.source[at] = source - room.min;
    }
    readWeights(path, map.patches, ctx);
    return map;
}

}  // namespace vdbsynth
