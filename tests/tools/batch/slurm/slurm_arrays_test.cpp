#include "tools/vdb_synth/batch/slurm/slurm_arrays.h"

#include <catch2/catch.hpp>

#include "libvdbsynth/base/error.h"
#include "tests/support/makers.h"

#include <algorithm>
#include <set>

using namespace vdbsynth;
using namespace vdbsynth::cli::batch;

namespace {

ArrayRequest request(std::size_t job, const std::string& entry, std::vector<std::size_t> needs = {}) {
    ArrayRequest made;
    made.job = job;
    made.entry = entry;
    made.needs = std::move(needs);
    return made;
}

struct Arrays {
    std::vector<ArrayPlan> plans;
    std::map<std::size_t, ArrayPlace> placed;
    std::map<int, std::string> ids;
    std::map<int, std::size_t> sizes;

    explicit Arrays(const std::vector<ArrayRequest>& requests, int largest = 1000) {
        int next = 1;
        plans = arraysOf(requests, placed, largest, next);
        for (const ArrayPlan& plan : plans) {
            ids[plan.number] = "10" + std::to_string(plan.number);
            sizes[plan.number] = plan.tasks.size();
        }
        CHECK(next == int(plans.size()) + 1);
    }
    std::string text(std::size_t i) const {
        return indexText(plans[i].tasks) + " " + dependencyText(plans[i], ids, sizes);
    }
};

}  // namespace

TEST_CASE("arraysOf: jobs of one entry share an array, each waits for its own", "[tools]") {
    // One exemplar, three results of it, a mesh of each, and a page about all.
    const Arrays arrays({request(7, "page", {1, 2, 3, 4, 5, 6}), request(0, "ball"), request(1, "more", {0}),
                         request(2, "more", {0}), request(3, "more", {0}), request(4, "mesh", {0, 1}),
                         request(5, "mesh", {0, 2}), request(6, "mesh", {0, 3})});
    REQUIRE(arrays.plans.size() == 4);
    CHECK(arrays.text(0) == "1 ");
    CHECK(arrays.text(1) == "1-3 afterok:101");
    CHECK(arrays.text(2) == "1-3 afterok:101,aftercorr:102");
    CHECK(arrays.text(3) == "1 afterok:102:103");
    CHECK(arrays.plans[2].tasks == std::map<int, std::size_t>{{1, 4}, {2, 5}, {3, 6}});
}

TEST_CASE("arraysOf: some tasks of an array are named one by one, and keep their indices", "[tools]") {
    const Arrays arrays({request(0, "a"), request(1, "a"), request(2, "a"), request(3, "a"),
                         request(4, "b", {3}), request(5, "b", {1}), request(6, "c", {0, 2})});
    REQUIRE(arrays.plans.size() == 3);
    CHECK(arrays.text(1) == "2,4 aftercorr:101");
    CHECK(arrays.plans[1].tasks == std::map<int, std::size_t>{{2, 5}, {4, 4}});
    CHECK(arrays.text(2) == "1 afterok:101_1:101_3");
}

TEST_CASE("arraysOf: what fits no common rule gets arrays of its own", "[tools]") {
    // Each needs two neighbours; two jobs need the same task and a third another.
    const Arrays pairs({request(0, "a"), request(1, "a"), request(2, "a"), request(3, "b", {0, 1}),
                        request(4, "b", {1, 2})});
    REQUIRE(pairs.plans.size() == 3);
    CHECK(pairs.text(1) == "1 afterok:101_1:101_2");
    CHECK(pairs.text(2) == "1 afterok:101_2:101_3");
    const Arrays shared(
        {request(0, "a"), request(1, "a"), request(2, "b", {0}), request(3, "b", {0}), request(4, "b", {1})});
    REQUIRE(shared.plans.size() == 3);
    CHECK(shared.text(1) == "1-2 afterok:101_1");
    CHECK(shared.text(2) == "1 afterok:101_2");
    // Two arrays of which the indices differ.
    const Arrays crossed({request(0, "a"), request(1, "a"), request(2, "b"), request(3, "b"),
                          request(4, "c", {0, 3}), request(5, "c", {1, 2})});
    CHECK(crossed.plans.size() == 4);
}

TEST_CASE("arraysOf: resources and the largest index part arrays", "[tools]") {
    std::vector<ArrayRequest> requests;
    for (std::size_t i = 0; i < 7; ++i) requests.push_back(request(i, "a"));
    requests[6].megabytes = 512;
    for (std::size_t i = 0; i < 6; ++i) requests.push_back(request(7 + i, "b", {i}));
    const Arrays arrays(requests, 4);
    REQUIRE(arrays.plans.size() == 5);
    CHECK(arrays.text(0) == "1-4 ");
    CHECK(arrays.text(1) == "1-2 ");
    CHECK(arrays.plans[2].megabytes == 512);
    CHECK(arrays.text(3) == "1-4 aftercorr:101");
    CHECK(arrays.text(4) == "1-2 aftercorr:102");
}

TEST_CASE("arraysOf: no array begins before what its tasks need", "[tools][property]") {
    std::vector<ArrayRequest> requests;
    for (std::size_t i = 0; i < 60; ++i) {
        std::vector<std::size_t> needs;
        for (std::size_t k = 1; k <= i; ++k)
            if ((i * 7 + k * k) % 11 == 0) needs.push_back(i - k);
        requests.push_back(request(i, std::to_string(i % 3), needs));
    }
    const Arrays arrays(requests, 5);
    std::set<std::size_t> seen;
    for (const ArrayPlan& plan : arrays.plans) {
        CHECK(plan.tasks.size() <= 5);
        for (const auto& [index, job] : plan.tasks)
            for (const std::size_t need : requests[job].needs) {
                CHECK(seen.count(need) == 1);
                const ArrayPlace place = arrays.placed.at(need);
                const bool whole =
                    std::count(plan.afterOk.begin(), plan.afterOk.end(), place) > 0 ||
                    (place.index == index && std::count(plan.afterCorresponding.begin(),
                                                        plan.afterCorresponding.end(), place.array) > 0);
                CHECK(whole);
            }
        for (const auto& [index, job] : plan.tasks) CHECK(seen.insert(job).second);
    }
    CHECK(seen.size() == 60);
}

TEST_CASE("arraysOf: jobs that have places already, and one without", "[tools][error]") {
    std::map<std::size_t, ArrayPlace> placed{{0, {3, 7}}};
    int next = 4;
    const std::vector<ArrayPlan> plans = arraysOf({request(1, "b", {0})}, placed, 10, next);
    CHECK(dependencyText(plans[0], {{3, "88"}}, {{3, 9}}) == "afterok:88_7");
    CHECK(placed.at(1) == ArrayPlace{4, 1});
    CHECK(test::thrownBy([&] { arraysOf({request(1, "b", {9})}, placed, 10, next); }).code ==
          int(ErrorCode::InvalidOption));
}

TEST_CASE("roomFor: a quarter more, in few sizes", "[tools]") {
    CHECK(roomFor(0) == 256);
    CHECK(roomFor(60000000) == 256);
    CHECK(roomFor(400ull << 20) == 640);    // 564
    CHECK(roomFor(1000ull << 20) == 1536);  // 1314
    CHECK(roomFor(1100ull << 20) == 1536);  // 1439
    std::set<long> sizes;
    for (std::uint64_t megabytes = 1; megabytes < 100000; megabytes += 37) {
        const long room = roomFor(megabytes << 20);
        CHECK(room >= long(megabytes) * 5 / 4);
        sizes.insert(room);
    }
    CHECK(sizes.size() < 45);
}
