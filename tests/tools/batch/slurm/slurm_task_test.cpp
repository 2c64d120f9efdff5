#include "tools/vdb_synth/batch/slurm/slurm_task.h"

#include <catch2/catch.hpp>

#include "libvdbsynth/base/error.h"
#include "tests/support/makers.h"
#include "tests/support/temporary_folder.h"
#include "tools/vdb_synth/batch/slurm/slurm_submission.h"

#include <algorithm>
#include <filesystem>

using namespace vdbsynth;
using namespace vdbsynth::cli::batch;

namespace {

Plan planOf(const test::TemporaryFolder& folder, const std::string& jobs) {
    return makePlan(readJobFile(folder.path("j.json"), Json::parse("{\"jobs\": [" + jobs + "]}"), {}));
}

const char* kJobs =
    R"({"name": "m", "command": "make", "inputs": "balls", "output": "m.vdb", "options": {"resolution": 24}},
    {"name": "s-${s}", "command": "synth", "inputs": "m.vdb", "output": ["s${s}.vdb", "s${s}.ply"],
     "options": {"size": "2x,1x,1x", "source-map": true}, "matrix": {"s": "1-2"}})";

}  // namespace

TEST_CASE("writeTaskFile: the same jobs come back", "[tools]") {
    const test::TemporaryFolder folder;
    const Plan plan = planOf(folder, kJobs);
    TaskFile tasks{"abc", 4, "/logs", plan, {2, 5, 9}};
    writeTaskFile(folder.path("t.json"), tasks);
    const TaskFile again = readTaskFile(folder.path("t.json"));
    CHECK(again.token == "abc");
    CHECK(again.number == 4);
    CHECK(again.logs == "/logs");
    CHECK(again.indices == tasks.indices);
    REQUIRE(again.plan.jobs.size() == 3);
    FileHashes hashes;
    folder.write("m.vdb", "x");
    for (std::size_t i = 0; i < 3; ++i) {
        CHECK(wordsOf(again.plan.jobs[i]) == wordsOf(plan.jobs[i]));
        CHECK(fingerprintOf(again.plan, again.plan.jobs[i], hashes) ==
              fingerprintOf(plan, plan.jobs[i], hashes));
    }
    tasks.plan.jobs[1].writes = {"\xff.vdb"};
    CHECK(test::contains(test::thrownBy([&] { writeTaskFile(folder.path("t.json"), tasks); }).message,
                         "not UTF-8"));
}

TEST_CASE("readTaskFile: what is refused", "[tools][error]") {
    const test::TemporaryFolder folder;
    for (const char* text : {"{}", "[]", "{\"format\": 9}", "{"})
        CHECK(test::thrownBy([&] { readTaskFile(folder.write("t.json", text)); }).code ==
              int(ErrorCode::BadData));
    CHECK(test::thrownBy([&] { readTaskFile(folder.path("no.json")); }).code == int(ErrorCode::Io));
    writeTaskFile(folder.path("t.json"), {"abc", 1, folder.path(""), planOf(folder, kJobs), {1, 2, 3}});
    CHECK(test::contains(test::thrownBy([&] { runTask(folder.path("t.json"), 4, {}); }).message,
                         "has no task of this number"));
}

TEST_CASE("readResult: of the task that wrote it, and of no other", "[tools]") {
    const test::TemporaryFolder folder;
    const std::string path = folder.path("r.json"), name = taskName("abc", 3, 12);
    CHECK(name == "abc.3.12");
    CHECK_FALSE(readResult(path, ""));
    TaskResult result{name, JobState::Failed, 1.5, 7, "why", {}};
    writeResult(path, result);
    REQUIRE(readResult(path, name));
    CHECK(readResult(path, name)->error == "why");
    CHECK(readResult(path, name)->state == JobState::Failed);
    CHECK_FALSE(readResult(path, name)->record);
    CHECK_FALSE(readResult(path, "abc.3.1"));
    result.state = JobState::Done;
    result.record = JobRecord{"f", {{"a.vdb", "hash"}}, 2, 9};
    writeResult(path, result);
    CHECK(readResult(path, "")->state == JobState::Done);
    CHECK(readResult(path, "")->record->outputs.at("a.vdb") == "hash");
    CHECK(readResult(path, "")->record->peakBytes == 9);
    folder.write("r.json", "{\"format\": 1");
    CHECK_FALSE(readResult(path, ""));
}

TEST_CASE("removeAllTemporaries: of a job's outputs, of any process", "[tools]") {
    const test::TemporaryFolder folder;
    const Plan plan = planOf(folder, kJobs);
    // Process 1 runs on every machine.
    for (const char* name : {".m.vdb.1.tmp", ".m.vdb.99-2.tmp", ".m.vdb.x.tmp", ".s1.vdb.1.tmp", "m.vdb"})
        folder.write(name, "");
    removeAllTemporaries(plan, plan.jobs[0], folder.path(""));
    std::vector<std::string> left;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path("")))
        left.push_back(entry.path().filename().string());
    std::sort(left.begin(), left.end());
    CHECK(left == std::vector<std::string>{".m.vdb.x.tmp", ".s1.vdb.1.tmp", "m.vdb"});
}

TEST_CASE("readSubmission: what was written, none, and a damaged one", "[tools]") {
    const test::TemporaryFolder folder;
    const std::string logs = folder.path("");
    CHECK_FALSE(readSubmission(logs));
    CHECK_NOTHROW(refuseSubmitted(logs));
    Submission submission = newSubmission();
    CHECK(submission.token.size() == 8);
    CHECK(newSubmission().token != submission.token);
    submission.arrays = {{1, "a-x-1", "12"}, {2, "b-x-2", ""}, {3, "b-x-3", "14"}};
    writeSubmission(logs, submission);
    REQUIRE(readSubmission(logs));
    CHECK(readSubmission(logs)->token == submission.token);
    CHECK(readSubmission(logs)->arrays[2].id == "14");
    CHECK(readSubmission(logs)->idText() == "12, 14");
    CHECK(test::contains(test::thrownBy([&] { refuseSubmitted(logs); }).message, "arrays 12, 14"));
    folder.write("slurm.json", "{\"format\": 1");
    CHECK(test::thrownBy([&] { readSubmission(logs); }).code == int(ErrorCode::BadData));
}
