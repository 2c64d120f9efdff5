#pragma once
#include "libvdbsynth/math/index_box.h"

#include <cstdint>
#include <vector>

namespace vdbsynth {

/// How often parts of an exemplar are sources of a target. A search for the most similar neighbourhood
/// prefers what is plain, since seams resemble nothing else: rare features and the finest relief become rarer
/// than in the exemplar. What is used more than its share costs more instead, as in [kaspar2015,
/// section 3.3]:
///     cost(row) = 1 + kWeight max(0, used(part) / share(part) - 1)
/// with parts of 4^3 voxels, used(part) the voxels of the target whose source lies in the part, and
/// share(part) as many of the target's voxels as the part has of all rows.
class SourceUsage {
public:
    struct Row {
        std::int32_t exemplar = 0;
        Index3 voxel;  ///< 0..65535 along each axis
    };
    SourceUsage() = default;
    /// @param rows     what may be a source @param targets  number of voxels of the target
    /// @par Cost       O(rows log rows)
    SourceUsage(const std::vector<Row>& rows, std::size_t targets);

    /// The factor on the squared distance of a row's features; 1 up to its share. @par Cost O(1)
    float cost(std::int32_t row) const;
    /// A voxel of the target changes its source; negative: it had none. Calls must come in one order for
    /// results to repeat. @par Cost O(1)
    void change(std::int32_t from, std::int32_t to);

private:
    std::vector<std::int32_t> mPart;   // of each row
    std::vector<float> mUsed, mShare;  // of each part [voxels of the target]
};

}  // namespace vdbsynth
