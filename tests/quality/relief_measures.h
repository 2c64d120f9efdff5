#pragma once
#include "libvdbsynth/pipeline/relief/relief.h"
#include "libvdbsynth/relief/relief_statistics.h"

#include <vector>

// Measures of relief for tests/quality/relief_quality.cpp.
namespace vdbsynth::quality {

/// Heights over a base [voxels], and their octaves.
struct Heights {
    std::vector<float> value;  ///< sorted
    ReliefStatistics statistics;
};

/// A sample's: of a picture over a plane, of a scan over its base.
Heights sampleHeights(const ReliefSource& source, const ReliefOptions& options);

/// A result's surface over its target.
BaseSurface madeSurface(const LevelSet& made, const LevelSet& target);
/// Its heights.
Heights madeHeights(const LevelSet& made, const LevelSet& target);

/// Mean distance between two distributions of heights about their means [voxels].
double wasserstein(const Heights& a, const Heights& b);

void printRightAnswers();
void printMismatch();

}  // namespace vdbsynth::quality
