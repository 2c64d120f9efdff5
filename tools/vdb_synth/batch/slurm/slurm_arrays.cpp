#include "tools/vdb_synth/batch/slurm/slurm_arrays.h"

#include "libvdbsynth/base/error.h"

#include <algorithm>
#include <set>
#include <tuple>

namespace vdbsynth::cli::batch {
namespace {

using Requests = std::vector<ArrayRequest>;
using Places = std::map<std::size_t, ArrayPlace>;

std::vector<ArrayPlace> needsOf(const ArrayRequest& request, const Places& placed) {
    std::vector<ArrayPlace> needs;
    for (const std::size_t job : request.needs) needs.push_back(placed.at(job));
    std::sort(needs.begin(), needs.end());
    return needs;
}

// Takes the jobs out whose needs all have places.
Requests takeReady(Requests& requests, const Places& placed) {
    const auto waits =
        std::stable_partition(requests.begin(), requests.end(), [&](const ArrayRequest& request) {
            return std::all_of(request.needs.begin(), request.needs.end(),
                               [&](std::size_t job) { return placed.count(job) > 0; });
        });
    Requests ready(requests.begin(), waits);
    requests.erase(requests.begin(), waits);
    return ready;
}

// Jobs that may share an array: of one entry, with equal resources, and needs in the same arrays.
std::vector<Requests> similar(const Requests& ready, const Places& placed) {
    using Key = std::tuple<std::string, int, long, std::set<int>>;
    std::map<Key, std::size_t> groupOf;
    std::vector<Requests> groups;
    for (const ArrayRequest& request : ready) {
        std::set<int> arrays;
        for (const ArrayPlace& need : needsOf(request, placed)) arrays.insert(need.array);
        const auto [group, added] =
            groupOf.insert({{request.entry, request.cores, request.megabytes, arrays}, groups.size()});
        if (added) groups.emplace_back();
        groups[group->second].push_back(request);
    }
    return groups;
}

struct Sharing {
    std::vector<ArrayPlace> afterOk;
    std::vector<int> afterCorresponding;
    std::vector<int> indices;  // one a job; empty: any
};

// How all jobs of a group can share one array; false if they cannot.
bool canShare(const Requests& group, const Places& placed, Sharing& sharing) {
    std::map<int, std::vector<std::vector<int>>> needed;  // by array, the indices that each job needs
    for (const ArrayRequest& request : group) {
        std::map<int, std::vector<int>> own;
        for (const ArrayPlace& need : needsOf(request, placed)) own[need.array].push_back(need.index);
        for (auto& [array, indices] : own) needed[array].push_back(indices);
    }
    for (const auto& [array, each] : needed) {
        if (std::all_of(each.begin(), each.end(), [&](const auto& one) { return one == each[0]; })) {
            for (const int index : each[0]) sharing.afterOk.push_back({array, index});
            continue;
        }
        std::vector<int> indices;
        for (const std::vector<int>& one : each)
            if (one.size() == 1) indices.push_back(one[0]);
        const bool distinct = std::set<int>(indices.begin(), indices.end()).size() == group.size();
        if (!distinct || (!sharing.indices.empty() && sharing.indices != indices)) return false;
        sharing.indices = indices;
        sharing.afterCorresponding.push_back(array);
    }
    return true;
}

// The group as arrays of at most `largest` tasks.
void addArrays(std::vector<ArrayPlan>& arrays, const Requests& group, const Sharing& sharing, int largest,
               int& next, Places& placed) {
    ArrayPlan plan;
    const auto flush = [&] {
        if (!plan.tasks.empty()) arrays.push_back(plan);
        plan = {next++,         group[0].entry,    {}, sharing.afterOk, sharing.afterCorresponding,
                group[0].cores, group[0].megabytes};
    };
    flush();
    for (std::size_t i = 0; i < group.size(); ++i) {
        if (int(plan.tasks.size()) == largest) flush();
        const int index = sharing.indices.empty() ? int(plan.tasks.size()) + 1 : sharing.indices[i];
        plan.tasks[index] = group[i].job;
        placed[group[i].job] = {plan.number, index};
    }
    arrays.push_back(plan);
}

}  // namespace

std::vector<ArrayPlan> arraysOf(std::vector<ArrayRequest> requests, Places& placed, int largest, int& next) {
    std::vector<ArrayPlan> arrays;
    while (!requests.empty()) {
        const Requests ready = takeReady(requests, placed);
        if (ready.empty())
            throw Error(ErrorCode::InvalidOption, "a job needs another that is not handed over with it");
        for (const Requests& group : similar(ready, placed)) {
            Sharing sharing;
            if (canShare(group, placed, sharing)) {
                addArrays(arrays, group, sharing, largest, next, placed);
                continue;
            }
            std::map<std::vector<ArrayPlace>, Requests> byNeeds;
            for (const ArrayRequest& request : group) byNeeds[needsOf(request, placed)].push_back(request);
            for (const auto& [needs, same] : byNeeds)
                addArrays(arrays, same, {needs, {}, {}}, largest, next, placed);
        }
    }
    return arrays;
}

std::string indexText(const std::map<int, std::size_t>& tasks) {
    std::string text;
    for (auto task = tasks.begin(); task != tasks.end();) {
        const int first = task->first;
        int last = first;
        for (++task; task != tasks.end() && task->first == last + 1; ++task) last = task->first;
        text += (text.empty() ? "" : ",") + std::to_string(first);
        if (last > first) text += "-" + std::to_string(last);
    }
    return text;
}

std::string dependencyText(const ArrayPlan& plan, const std::map<int, std::string>& ids,
                           const std::map<int, std::size_t>& sizes) {
    std::map<int, std::vector<int>> needed;
    for (const ArrayPlace& place : plan.afterOk) needed[place.array].push_back(place.index);
    std::string ok, text;
    for (const auto& [array, indices] : needed) {
        const std::string& id = ids.at(array);
        if (indices.size() == sizes.at(array)) {
            ok += ":" + id;
            continue;
        }
        for (const int index : indices) ok += ":" + id + "_" + std::to_string(index);
    }
    if (!ok.empty()) text = "afterok" + ok;
    for (const int array : plan.afterCorresponding)
        text += (text.empty() ? "" : ",") + std::string("aftercorr:") + ids.at(array);
    return text;
}

long roomFor(std::uint64_t peakBytes) {
    const std::uint64_t wanted = std::max<std::uint64_t>(peakBytes / 4 * 5 / (1 << 20) + 64, 256);
    std::uint64_t step = 1;
    while (step * 8 <= wanted) step *= 2;
    return long((wanted + step - 1) / step * step);
}

}  // namespace vdbsynth::cli::batch
