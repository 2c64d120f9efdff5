#include "libvdbsynth/map/source_map.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/math/lattice.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

constexpr double kFarthest = 1 << 30;  // [voxels] limit of any coordinate, so that sums of two fit

// The source that a block of the lattice gives a voxel of the target.
Source sourceOf(const SourceMap& map, const Index3& block, const Index3& voxel) {
    const Index3 local = voxel - map.targetBox.min;
    const std::size_t at = map.patches.index(block), number = std::size_t(map.patches.exemplar[at]);
    const Index3 from = map.patches.source[at] + local - map.patches.originOf(block);
    Source source;
    source.exemplar = map.variants.empty() ? std::int32_t(number) : map.variants[number].exemplar;
    const IndexBox& box = map.exemplars[std::size_t(source.exemplar)].box;
    if (map.variants.empty()) {
        const Index3 place = from + box.min;
        source.position = {double(place.x), double(place.y), double(place.z)};
        return source;
    }
    const ExemplarVariant& variant = map.variants[number];
    const Vec3d p = inExemplar(variant, box.size(), {double(from.x), double(from.y), double(from.z)});
    for (int axis = 0; axis < 3; ++axis) source.position[axis] = box.min[axis] + p[axis];
    source.rotation = cast<float>(variant.rotation);
    source.scale = float(variant.scale);
    return source;
}

bool reaches(const IndexBox& box, double farthest) {
    for (int axis = 0; axis < 3; ++axis)
        if (std::abs(double(box.min[axis])) > farthest || std::abs(double(box.max[axis])) > farthest)
            return true;
    return false;
}

void requireBlocksAt(const SourceMap& map, const Index3& voxel) {
    if (map.patches.source.empty() || map.exemplars.empty())
        throw Error(ErrorCode::InvalidOption, "`map`: has no blocks; only maps of synthesis and fills do");
    if (!map.targetBox.contains(voxel))
        throw Error(ErrorCode::InvalidOption, "`voxel`: lies outside the map's target");
}

// Thrown inside requireSound, which adds the name of the map.
struct Unsound {
    std::string what;
};

void require(bool sound, const char* what) {
    if (!sound) throw Unsound{what};
}

// Box of the sources of an exemplar or variant.
IndexBox sourceBoxOf(const SourceMap& map, std::int32_t number) {
    return IndexBox::fromSize(map.variants.empty() ? map.exemplars[std::size_t(number)].box.size()
                                                   : map.variants[std::size_t(number)].size);
}

void requireSoundPatches(const SourceMap& map) {
    const PatchMap& patches = map.patches;
    require(patches.target == map.targetBox.size(), "has blocks for another target");
    require(patches.block >= 1 && patches.stride >= 1 && patches.stride <= patches.block,
            "has a bad patch or stride");
    const Index3 n = patches.lattice();
    require(double(n.x) * double(n.y) * double(n.z) == double(patches.source.size()) &&
                patches.exemplar.size() == patches.source.size() &&
                (patches.weight.empty() || patches.weight.size() == patches.source.size()),
            "has too few or too many blocks");
    const std::size_t count = map.variants.empty() ? map.exemplars.size() : map.variants.size();
    for (std::size_t i = 0; i < patches.source.size(); ++i) {
        const std::int32_t number = patches.exemplar[i];
        require(number >= 0 && std::size_t(number) < count, "names an exemplar that it does not have");
        require(sourceBoxOf(map, number).contains(patches.source[i]), "points outside the exemplar");
    }
    for (float weight : patches.weight)
        require(weight > 0 && weight <= 1, "has a vote weight that is not over 0 and at most 1");
}

void requireSoundElements(const SourceMap& map) {
    require(map.elements.kind() == ElementKind::Voxel, "of an analogy is not of voxels");
    for (std::size_t i = 0; i < map.elements.size(); ++i) {
        require(map.targetBox.contains(map.elements.voxels()[i]), "has voxels outside its target");
        for (const Source& source : map.elements[i]) {
            require(source.exemplar >= 0 && std::size_t(source.exemplar) < map.exemplars.size(),
                    "names an exemplar that it does not have");
            require(
                map.exemplars[std::size_t(source.exemplar)].box.expanded(2).contains(nearestVoxel(source)),
                "points outside the exemplar");
            require(length(source.rotation) <= 100 && source.scale >= 0.2f && source.scale <= 5,
                    "has a rotation or a scale out of range");
        }
    }
}

void requireSoundVariants(const SourceMap& map) {
    for (const ExemplarVariant& variant : map.variants) {
        require(variant.exemplar >= 0 && std::size_t(variant.exemplar) < map.exemplars.size() &&
                    length(variant.rotation) <= 100 && variant.scale >= 0.2 && variant.scale <= 5,
                "has a bad variant");
        // The box of a rotated and scaled box is no longer than the diagonal.
        const Index3 from = map.exemplars[std::size_t(variant.exemplar)].box.size();
        const double most = length(Vec3d{double(from.x), double(from.y), double(from.z)}) * 5 + 1;
        for (int axis = 0; axis < 3; ++axis)
            require(variant.size[axis] >= 1 && variant.size[axis] <= most, "has a bad variant");
    }
}

void requireAll(const SourceMap& map) {
    require(!map.exemplars.empty(), "has no exemplar");
    for (const MappedExemplar& exemplar : map.exemplars)
        require(!exemplar.box.empty() && !reaches(exemplar.box, kFarthest), "has a bad exemplar_box");
    require(!map.targetBox.empty() && !reaches(map.targetBox, kFarthest), "has a bad target_box");
    requireSoundVariants(map);
    if (map.method == MapMethod::Analogy)
        requireSoundElements(map);
    else
        requireSoundPatches(map);
    if (map.method == MapMethod::Analogy) {
        require(!map.analogy.depths.empty(), "does not record which depths are complete");
        return;
    }
    require(map.targetBox.contains(map.targetDomain), "has a domain that lies outside its box");
    if (map.method == MapMethod::Fill) require(!map.hole.distance.box().empty(), "has no hole");
}

}  // namespace

Index3 nearestVoxel(const Source& source) {
    const auto round = [](double v) { return int(std::floor(v + 0.5)); };
    return {round(source.position.x), round(source.position.y), round(source.position.z)};
}

Source strongestSource(const SourceMap& map, const Index3& voxel) {
    requireBlocksAt(map, voxel);
    return sourceOf(map, strongestBlock(map.patches, voxel - map.targetBox.min), voxel);
}

std::vector<Source> votingSources(const SourceMap& map, const Index3& voxel) {
    requireBlocksAt(map, voxel);
    const Index3 local = voxel - map.targetBox.min, strongest = strongestBlock(map.patches, local);
    if (map.patches.vote == PatchVote::First) return {sourceOf(map, strongest, voxel)};
    const float least = blockWeight(map.patches, strongest, local) / 100;
    IndexBox over;
    for (int axis = 0; axis < 3; ++axis)
        map.patches.covering(axis, local[axis], over.min[axis], over.max[axis]);
    std::vector<Source> sources;
    forEachVoxel(over, [&](const Index3& block) {
        const float weight = blockWeight(map.patches, block, local);
        if (weight < least) return;
        sources.push_back(sourceOf(map, block, voxel));
        sources.back().weight = weight;
    });
    return sources;
}

Index3 coarserVoxel(const Index3& voxel, int factor) {
    const int shift = -((factor - 1) / 2);
    Index3 coarse;
    for (int axis = 0; axis < 3; ++axis) {
        const int from = voxel[axis] - shift;
        coarse[axis] = from >= 0 ? from / factor : -((-from + factor - 1) / factor);
    }
    return coarse;
}

Source finerSource(const SourceMap& map, std::size_t element, const Index3& voxel) {
    Source source = *map.elements.strongest(element);
    const Index3 middle = map.elements.voxels()[element] * map.finer, by = voxel - middle;
    const Vec3d moved = transformed(rotationMatrix(-cast<double>(source.rotation)),
                                    {double(by.x), double(by.y), double(by.z)});
    source.position = source.position * double(map.finer) + moved * (1 / double(source.scale));
    return source;
}

IndexBox finerBox(const IndexBox& box, int factor) {
    const int shift = -((factor - 1) / 2);
    const Index3 by{shift, shift, shift};
    return {box.min * factor + by, (box.max + Index3{1, 1, 1}) * factor + by - Index3{1, 1, 1}};
}

SourceMap finerMap(const SourceMap& map, int factor) {
    requireOption(factor >= 1 && factor <= 64, "factor", std::to_string(factor),
                  "a whole number from 1 to 64");
    SourceMap scaled = map;
    if (factor == 1) return scaled;
    const double farthest = kFarthest / factor - 1;
    bool beyond = reaches(map.targetBox, farthest) || reaches(map.targetDomain, farthest);
    for (const MappedExemplar& exemplar : map.exemplars) beyond = beyond || reaches(exemplar.box, farthest);
    for (const ExemplarVariant& variant : map.variants)
        beyond = beyond || reaches(IndexBox::fromSize(variant.size), farthest);
    if (beyond)
        throw Error(ErrorCode::ShapeMismatch,
                    "the source map at " + std::to_string(factor) +
                        " times its resolution has coordinates beyond 2^30; use exemplars of larger voxels");
    for (MappedExemplar& exemplar : scaled.exemplars) exemplar.box = finerBox(exemplar.box, factor);
    for (ExemplarVariant& variant : scaled.variants) variant.size = variant.size * factor;
    scaled.targetBox = finerBox(map.targetBox, factor);
    scaled.targetDomain = finerBox(map.targetDomain, factor);
    scaled.band = map.band * float(factor);
    if (map.method == MapMethod::Analogy)
        scaled.finer = map.finer * factor;
    else
        scaled.patches = map.patches.scaled(factor, scaled.targetBox.size());
    scaled.matched = map.matched * factor;
    scaled.draft = false;  // the finer exemplar gives the full resolution
    return scaled;
}

void requireSound(const SourceMap& map, const std::string& what) {
    try {
        requireAll(map);
    } catch (const Unsound& unsound) {
        throw Error(ErrorCode::BadData, what + " " + unsound.what);
    }
}

}  // namespace vdbsynth
