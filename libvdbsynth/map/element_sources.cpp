#include "libvdbsynth/map/element_sources.h"

#include "libvdbsynth/base/error.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace vdbsynth {

void ElementSources::append(const Source& source) {
    const Vec3d& p = source.position;
    // Texts are made for what is refused alone: millions of sources are added.
    if (!(source.weight > 0) || !std::isfinite(source.weight))
        requireOption(false, "weight", std::to_string(source.weight), "over 0");
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
        requireOption(false, "position", "nan", "three finite numbers");
    mSources.push_back(source);
}

void ElementSources::add(std::vector<Source> sources) {
    if (mKind == ElementKind::Voxel)
        requireOption(false, "kind", "voxel", "another kind; voxels are added by position");
    std::stable_sort(sources.begin(), sources.end(),
                     [](const Source& a, const Source& b) { return a.weight > b.weight; });
    for (const Source& source : sources) append(source);
    mEnd.push_back(mSources.size());
}

void ElementSources::add(const Index3& voxel, const Source& source) {
    if (mKind != ElementKind::Voxel)
        requireOption(false, "kind", "point, vertex or corner", "voxel; other elements are added in order");
    append(source);
    mVoxels.push_back(voxel);
    mEnd.push_back(mSources.size());
}

}  // namespace vdbsynth
