#pragma once
#include "libvdbsynth/grid/voxel_table.h"
#include "libvdbsynth/map/source_map.h"
#include "libvdbsynth/surface/frame_field.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace vdbsynth {

/// Curvature of a surface relative to a frame's plane: second fundamental form of the plain
/// model's surface through the voxel, along t and b, positive for a convex surface such as a
/// ball's. [1 / voxels of the level]
struct Curvature {
    float tt = 0, tb = 0, bb = 0;
};

/// The voxels of one model at one level of the pyramid, each with its frame. [voxels of the level]
struct AnalogyVoxels {
    VoxelTable table;
    std::vector<Frame> frame;
    std::vector<Curvature> curvature;  ///< all 0 unless requested
    std::vector<float> sweep;          ///< [voxels of the finest level]
};

/// A field at every level, finest first: distances in voxels of the level, and the densities clamp(1/2 - d/2,
/// 0, 1) from which features are built.
struct AnalogyPyramid {
    std::vector<BrickField> distance, density;
};

/// @par Repeats same bits for any number of threads
AnalogyPyramid analogyPyramid(const BrickField& distance, int levels, const RunContext& ctx);

inline float densityOf(float distance) {
    const float d = 0.5f - 0.5f * distance;
    return d < 0 ? 0.f : d > 1 ? 1.f : d;
}
BrickField densityField(const BrickField& distance, const RunContext& ctx);

/// Converts a level's position to the finest level: the centres of the boxes' first voxels are
/// half a coarse voxel apart.
inline Vec3f toFinest(const Vec3f& p, int level) {
    const float scale = float(1 << level), shift = (scale - 1) / 2;
    return {p.x * scale + shift, p.y * scale + shift, p.z * scale + shift};
}

/// Frames and sweep distances of voxels; voxels far from the surface take their neighbours'.
/// @param aligned  false: every frame is that of the grid's axes, in slice order (the naive variant)
/// @param curvatureAdapted  true: curvatures too, from differences of the normals two voxels of the level
/// apart, at most kMostCurvature
/// @par Repeats same bits for any number of threads
AnalogyVoxels analogyVoxels(VoxelTable table, const FrameField& frames, int level, bool aligned,
                            bool curvatureAdapted, const RunContext& ctx);
inline constexpr float kMostCurvature = 0.2f;  ///< beyond it, columns five voxels apart would cross

/// The phase of textured models at each depth of the plain ones, and so which voxels of a target must be
/// synthesised: those at depths whose neighbourhood is not all of one phase. In whole voxels of distance.
class DepthClasses {
public:
    enum class Kind : std::uint8_t { Unseen, Full, Empty, Mixed };

    explicit DepthClasses(int radius);
    /// Records the phase of a textured model at a depth. Outside it `textured` is at
    /// least 1, inside at most -1.
    void add(float plain, float textured);
    /// Computes the classes; depths beyond all recorded ones take the class of the nearest recorded one.
    void finish();

    /// True where voxels at this depth have to be synthesised.
    bool open(float plain) const { return mOpen[index(plain)]; }
    bool full(float plain) const { return mKind[index(plain)] == Kind::Full; }
    /// The same for a map, where every depth is full or empty: mixed ones take the plain model's phase.
    std::vector<DepthRun> runs() const;

private:
    static constexpr int kDeepest = 512;
    static std::size_t index(float plain);
    int mRadius;
    std::vector<Kind> mKind;
    std::vector<char> mOpen;
};

}  // namespace vdbsynth
