#pragma once
#include "libvdbsynth/procedural/exemplar.h"
#include "libvdbsynth/procedural/primitives.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace vdbsynth {

/// Input of one kind. `box` is the domain enlarged by the margin.
struct ExemplarRequest {
    IndexBox domain, box;
    double feature = 16;
    std::uint64_t seed = 0;
};

// One function per kind, each in its own file if it is more than a list of primitives.
std::vector<Primitive> ballsPrimitives(const ExemplarRequest& request, const RunContext& ctx);
std::vector<Primitive> gridPrimitives(const ExemplarRequest& request);
std::vector<Primitive> chainmailPrimitives(const ExemplarRequest& request);
std::vector<Primitive> flowersPrimitives(const ExemplarRequest& request);
std::vector<Primitive> fibresPrimitives(const ExemplarRequest& request);
std::vector<Primitive> threeToriPrimitives(const ExemplarRequest& request);
std::vector<Primitive> weavePrimitives(const ExemplarRequest& request);
BrickField foamField(const ExemplarRequest& request, const RunContext& ctx);
/// Zero on the surface, negative inside, about distances [voxels] near it.
std::function<double(const Vec3d&)> spongeSurface(const ExemplarRequest& request);
BrickField spongeField(const ExemplarRequest& request, const RunContext& ctx);

/// Height [voxels] of the solid's top at x, y.
using Heights = std::function<double(double, double)>;
Heights bumpsHeights(const ExemplarRequest& request);
Heights terrainHeights(const ExemplarRequest& request);
/// The solid below. Values are heights above its top, no distances.
BrickField heightsField(const ExemplarRequest& request, const Heights& heights, const RunContext& ctx);

}  // namespace vdbsynth
