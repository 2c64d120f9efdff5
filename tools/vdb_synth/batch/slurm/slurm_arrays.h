#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace vdbsynth::cli::batch {

/// A place in a job array.
struct ArrayPlace {
    int array = 0;  ///< its number in the submission
    int index = 0;  ///< of the task
    bool operator<(const ArrayPlace& other) const {
        return array != other.array ? array < other.array : index < other.index;
    }
    bool operator==(const ArrayPlace& other) const { return array == other.array && index == other.index; }
};

/// A job to hand over.
struct ArrayRequest {
    std::size_t job = 0;
    std::string entry;               ///< of the job file: jobs of one entry share arrays
    std::vector<std::size_t> needs;  ///< jobs that have not ended and must be done before it
    int cores = 1;
    long megabytes = 0;  ///< as ArrayPlan::megabytes
};

/// A job array, in the terms of sbatch.
struct ArrayPlan {
    int number = 0;
    std::string entry;
    std::map<int, std::size_t> tasks;     ///< job by index; indices are from 1
    std::vector<ArrayPlace> afterOk;      ///< tasks that must be done before all of its tasks
    std::vector<int> afterCorresponding;  ///< arrays whose task of the same index must be done before
    int cores = 1;
    long megabytes = 0;  ///< 0: the cluster's own, kAllMemory: all of a node
};

inline constexpr long kAllMemory = -1;

/// Jobs as few job arrays, so that each waits for no more than it needs. Jobs of one entry with equal
/// resources share an array if they need the same tasks, or each one task of an array and no two the same:
/// such a task has the index of the one it needs. Others get arrays of their own. Arrays come after those
/// they need.
/// @param placed   jobs that have a place already; those of the result are added
/// @param largest  index that Slurm allows, at least 1
/// @param next     number of the next array; goes up
/// @throw Error InvalidOption (a need has no place and is not among the jobs)
/// @par Cost    O(jobs x needs log jobs)   @par Repeats yes
std::vector<ArrayPlan> arraysOf(std::vector<ArrayRequest> requests, std::map<std::size_t, ArrayPlace>& placed,
                                int largest, int& next);

/// "1-3,7": the indices of an array as --array takes them.
std::string indexText(const std::map<int, std::size_t>& tasks);

/// The argument of --dependency, empty if there is none: "afterok:12_3:13,aftercorr:14".
/// @param ids    Slurm's numbers by the arrays' own
/// @param sizes  tasks of each array: one that is needed whole is named as such
std::string dependencyText(const ArrayPlan& plan, const std::map<int, std::string>& ids,
                           const std::map<int, std::size_t>& sizes);

/// Megabytes (2^20 bytes) for a job that took so many bytes before: a quarter more and 64, rounded up to
/// 4, 5, 6 or 7 times a power of two, so that jobs of about the same size share an array; at least 256.
long roomFor(std::uint64_t peakBytes);

}  // namespace vdbsynth::cli::batch
