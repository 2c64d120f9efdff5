#pragma once
#include "libvdbsynth/analogy/source_usage.h"
#include "libvdbsynth/analogy/volume_analogy_steps.h"
#include "libvdbsynth/base/parallel.h"

#include <cstdint>
#include <vector>

// One level of volume_analogy; for its .cpp files only.
namespace vdbsynth {

/// The state that a level passes to the next finer one.
struct AnalogyLevelResult {
    BrickField distance, density;
    VoxelTable table;
    std::vector<Frame> frame;
    std::vector<AnalogyRow> source;  // pair -1: none
    std::vector<Vec3f> sourcePlace;
    std::vector<Frame> sourceFrame;
};

/// The target at one level: an assignment of a source row to every voxel that has to be synthesised.
/// Between two waves:
/// - mSource[i] is a position of a pair, or none as long as none was found for voxel i of mVoxels;
/// - mDistance is the field as synthesised so far, full or empty (-kAnalogyFar, kAnalogyFar) where nothing
///   has to be, and mDensity is densityField of it;
/// - mUsage counts mSource;
/// - mChanged[i] and mComputed[i] are the waves (counted by mNow) in which voxel i last got another source
/// and
///   was last searched; a later sweep searches only voxels that changed, or have a neighbour that did, since;
/// - a wave reads only the state before it and writes mFound, which is then applied in order, so results do
///   not depend on threads.
class AnalogyLevel {
public:
    AnalogyLevel(const AnalogyTraining& training, const AnalogyPyramid& target, const FrameField& frames,
                 int level, const FeatureShape& shape, const AnalogyLevelResult* coarser,
                 const VolumeAnalogyOptions& options, const RunContext& ctx);

    /// All sweeps.
    AnalogyLevelStats run();
    /// What the next finer level begins from.
    AnalogyLevelResult made();
    /// Of the finest level, for the map.
    ElementSources sources() const;

private:
    template <typename Work>
    void each(std::size_t grain, Work&& work) const {
        parallelFor(mContext, mVoxels.table.size(), grain, [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i) work(i);
        });
    }

    // Voxels that need no computation are full or empty; the others start from the plain target, or from the
    // coarser level's result.
    void begin();

    // Nothing would grow on a plain surface: it resembles the plainest part of the texture everywhere. So the
    // coarsest level begins with patches of the textured model, placed side by side without regard to seams.
    void layPatches();

    // What a coarser level passes on lacks all that is finer than it. Searched beside that, the plainest part
    // of the texture would be the most similar, and the finest relief would be lost everywhere, not at seams.
    void readSources();

    void countSources();
    // The source of the coarser level's voxel, offset from its middle as this voxel
    // is from the coarser voxel's.
    AnalogySource inherited(std::size_t i) const;

    // Feature distances of the sources and of the nearest rows.
    void probe(AnalogyLevelStats& stats) const;

    Vec3f placeOf(std::size_t i) const;
    void featureOf(std::size_t i, std::vector<float>& made, std::vector<float>& feature) const;
    // Voxels in the order of waves; the beginning of each wave, and the end.
    std::vector<std::size_t> orderWaves();
    void projectRests();
    void runWave(std::size_t first, std::size_t last, bool searched);

    // True if a neighbour's source changed since the voxel was last computed; otherwise the search would find
    // the same source again.
    bool changedAround(std::uint32_t i) const;

    struct Found {
        AnalogySource source;
        float distance = 0;
        char coherent = 0;
    };

    Found match(std::uint32_t i, bool searched, std::vector<float>& made, std::vector<float>& feature) const;

    struct Candidate {
        AnalogySource source;
        float squared = kOutside;
    };

    // The nearest of the candidates that continue the voxel's own source and its neighbours'.
    Candidate bestCandidate(std::uint32_t i, const float* feature) const;

    // The source of a voxel's neighbour j, moved to the voxel along the surface and to the voxel's own depth.
    AnalogySource continued(std::size_t i, std::size_t j, const Index3& step) const;

    // The value that a voxel's source proposes for a position: the textured distance, offset from the source
    // in its frame as the position is from the voxel; the source is first moved to the voxel's own depth.
    float readThrough(std::size_t i, const AnalogySource& source, const Index3& place) const;

    // A source moved along its normal to the voxel's own depth.
    Vec3f atDepth(std::size_t i, const AnalogySource& source) const;

    // Means of the proposals of a voxel and its neighbours.
    BrickField voted();

    const AnalogyTraining& mTraining;
    const BrickField &mPlain, &mPlainDensity;
    const BrickField* mCoarsePlain;
    FeatureShape mShape;
    const AnalogyLevelResult* mCoarser;
    const VolumeAnalogyOptions& mOptions;
    const RunContext& mContext;
    int mLevel;
    AnalogyVoxels mVoxels;
    BrickField mDistance, mDensity;  // of the field being synthesised
    std::vector<AnalogySource> mSource;
    std::vector<char> mCoherent;
    SourceUsage mUsage;                              // of mSource
    std::uint32_t mNow = 0;                          // waves so far
    std::vector<std::uint32_t> mChanged, mComputed;  // the wave in which each voxel last did or was
    std::vector<float> mRest;
    std::vector<std::uint32_t> mOrder;
    std::vector<Found> mFound;
};

}  // namespace vdbsynth
