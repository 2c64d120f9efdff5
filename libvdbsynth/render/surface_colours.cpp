#include "libvdbsynth/render/surface_colours.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/vdb/coord.h"
#include "libvdbsynth/vdb/grid_kinds.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string>

namespace vdbsynth {
namespace {

bool holdsColours(const openvdb::GridBase& grid) {
    return (grid.isType<openvdb::Vec3SGrid>() || grid.isType<openvdb::Vec3DGrid>()) &&
           grid.transform().isLinear();
}

std::string lowered(std::string text) {
    for (char& c : text) c = char(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

}  // namespace

GridPtr colourGridOf(const std::vector<GridPtr>& attributes) {
    for (const char* name : {"cd", "color", "colour", "rgb"})
        for (const GridPtr& grid : attributes)
            if (grid && holdsColours(*grid) && lowered(grid->getName()) == name) return grid;
    return nullptr;
}

struct SurfaceColours::Reader {
    virtual ~Reader() = default;
    virtual bool at(const Vec3d& place, Vec3f& colour) = 0;
    virtual std::unique_ptr<Reader> copy() const = 0;
};

template <typename GridType>
struct SurfaceColours::ReaderOf final : Reader {
    const GridType* grid;
    typename GridType::ConstAccessor accessor;

    explicit ReaderOf(const GridType* of) : grid(of), accessor(of->getConstAccessor()) {}
    std::unique_ptr<Reader> copy() const override { return std::make_unique<ReaderOf>(grid); }

    bool at(const Vec3d& place, Vec3f& colour) override {
        const openvdb::Vec3d p = grid->worldToIndex(toVec(place));
        const openvdb::Coord base = openvdb::Coord::floor(p);
        Vec3f sum;
        float weights = 0;
        for (int i = 0; i < 8; ++i) {
            const openvdb::Coord voxel = base.offsetBy(i >> 2, i >> 1 & 1, i & 1);
            typename GridType::ValueType value;
            if (!accessor.probeValue(voxel, value)) continue;
            const double weight = 1e-6 + (1 - std::abs(p.x() - voxel.x())) *
                                             (1 - std::abs(p.y() - voxel.y())) *
                                             (1 - std::abs(p.z() - voxel.z()));
            sum = sum + Vec3f{float(value[0]), float(value[1]), float(value[2])} * float(weight);
            weights += float(weight);
        }
        if (!(weights > 0)) return false;
        colour = sum * (1 / weights);
        return std::isfinite(colour.x) && std::isfinite(colour.y) && std::isfinite(colour.z);
    }
};

SurfaceColours::SurfaceColours(const GridConstPtr& grid) {
    if (!grid) throw Error(ErrorCode::InvalidOption, "`colours`: null; a grid of vectors is needed");
    if (!holdsColours(*grid))
        throw Error(ErrorCode::BadData, "`colours`: grid " + grid->getName() + " holds " + grid->valueType() +
                                            "; colours are vectors of three floats");
    if (grid->isType<openvdb::Vec3SGrid>())
        mReader = std::make_unique<ReaderOf<openvdb::Vec3SGrid>>(
            static_cast<const openvdb::Vec3SGrid*>(grid.get()));
    else
        mReader = std::make_unique<ReaderOf<openvdb::Vec3DGrid>>(
            static_cast<const openvdb::Vec3DGrid*>(grid.get()));
}
SurfaceColours::~SurfaceColours() = default;
SurfaceColours::SurfaceColours(const SurfaceColours& other) : mReader(other.mReader->copy()) {}

bool SurfaceColours::at(const Vec3d& place, Vec3f& colour) {
    return mReader->at(place, colour);
}

}  // namespace vdbsynth
