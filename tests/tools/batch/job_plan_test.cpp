#include "tools/vdb_synth/batch/job_plan.h"

#include <catch2/catch.hpp>

#include "libvdbsynth/base/error.h"
#include "tests/support/makers.h"
#include "tests/support/temporary_folder.h"
#include "tools/vdb_synth/batch/job_manifest.h"
#include "tools/vdb_synth/batch/referred_files.h"
#include "tools/vdb_synth/batch/status_page.h"
#include "tools/vdb_synth/version.h"

using namespace vdbsynth;
using namespace vdbsynth::cli::batch;

namespace {

Plan planOf(const test::TemporaryFolder& folder, const std::string& jobs, const std::string& more = "") {
    return makePlan(
        readJobFile(folder.path("j.json"), Json::parse("{" + more + "\"jobs\": [" + jobs + "]}"), {}));
}

std::vector<std::string> namesOf(const Plan& plan) {
    std::vector<std::string> names;
    for (const Job& job : plan.jobs) names.push_back(job.name);
    return names;
}

const char* kMake = R"({"name": "m", "command": "make", "inputs": "balls", "output": "m.vdb"})";

}  // namespace

TEST_CASE("makePlan: the product of a matrix and frames, the last key fastest", "[tools]") {
    const test::TemporaryFolder folder;
    folder.write("b.vdb", "");
    folder.write("a.vdb", "");
    const Plan plan =
        planOf(folder, R"({"name": "x", "command": "convert", "inputs": "${model}", "frames": "1,3",
        "output": "o/${model.stem}-${v}.####.ply", "options": {"voxel-size": "${v}"}, "matrix": {"model": "?.vdb", "v": [0.5, "2"]}})");
    CHECK(namesOf(plan) == std::vector<std::string>{"x-a-0.5.0001", "x-a-0.5.0003", "x-a-2.0001",
                                                    "x-a-2.0003", "x-b-0.5.0001", "x-b-0.5.0003",
                                                    "x-b-2.0001", "x-b-2.0003"});
    CHECK(wordsOf(plan.jobs[1]) ==
          std::vector<std::string>{"convert", "a.vdb", "--output=o/a-0.5.0003.ply", "--voxel-size=0.5"});
    CHECK(plan.jobs[1].reads == std::vector<std::string>{"a.vdb"});
    CHECK(plan.jobs[1].writes == std::vector<std::string>{"o/a-0.5.0003.ply"});
}

TEST_CASE("makePlan: dependencies by equal paths, patterns and names", "[tools]") {
    const test::TemporaryFolder folder;
    const Plan plan = planOf(
        folder,
        std::string(R"({"name": "late", "command": "info", "inputs": "./x/../m.vdb"},)") + kMake +
            R"(,{"name": "s-${s}", "command": "synth", "inputs": "m.vdb", "output": "s${s}.vdb", "options": {"size": "2x,1x,1x"}, "matrix": {"s": "1-2"}},
           {"name": "c", "command": "compare", "inputs": ["m.vdb", "s?.vdb"]},
           {"name": "d", "command": "make", "inputs": ["grid", "d.vdb"], "after": "s-${s}", "matrix": {"s": [2]}},
           {"name": "e", "command": "mask", "inputs": ["inside", "m.vdb"], "output": "e.vdb", "after": ["s-${s}"], "matrix": {"s": [1]}})");
    CHECK(plan.jobs[0].after == std::vector<std::size_t>{1});
    CHECK(plan.jobs[4].after == std::vector<std::size_t>{1, 2, 3});
    CHECK(plan.jobs[4].reads == std::vector<std::string>{"m.vdb", "s1.vdb", "s2.vdb"});
    CHECK(plan.jobs[5].after == std::vector<std::size_t>{3});
    CHECK(plan.jobs[5].writes == std::vector<std::string>{"d.vdb"});
    CHECK(plan.jobs[6].after == std::vector<std::size_t>{1, 2});
    CHECK(planJson(plan)["jobs"].size() == 7);
}

TEST_CASE("wordsOf: flags and options without a value end the line", "[tools]") {
    const test::TemporaryFolder folder;
    folder.write("-a.vdb", "");
    const Plan plan =
        planOf(folder, R"({"name": "x", "command": "synth", "inputs": "-a.vdb", "output": "it's.vdb",
        "options": {"source-map": true, "draft": true, "size": "2x,1x,1x", "verbose": false}})");
    CHECK(wordsOf(plan.jobs[0]) == std::vector<std::string>{"synth", "./-a.vdb", "--output=it's.vdb",
                                                            "--size=2x,1x,1x", "--draft", "--source-map"});
    CHECK(shellText({"a b", "it's", "", "x=1"}) == "'a b' 'it'\\''s' '' x=1");
}

TEST_CASE("makePlan: what is refused", "[tools][error]") {
    const test::TemporaryFolder folder;
    const auto refusal = [&](const std::string& jobs, int code = int(ErrorCode::InvalidOption)) {
        const test::Thrown thrown = test::thrownBy([&] { planOf(folder, jobs); });
        CHECK(thrown.code == code);
        return thrown.message;
    };
    CHECK(test::contains(refusal(std::string(kMake) + "," + kMake), "two jobs have this name"));
    CHECK(test::contains(
        refusal(
            R"({"name": "m", "command": "make", "inputs": "balls", "output": "m.vdb", "matrix": {"a": [1, 2]}})"),
        "writes it too"));
    CHECK(
        test::contains(refusal(R"({"name": "a", "command": "info", "inputs": "n.vdb"},)" + std::string(kMake),
                               int(ErrorCode::Io)),
                       "did you mean m.vdb?"));
    CHECK(test::contains(
        refusal(R"({"name": "a", "command": "info", "inputs": "m.vdb", "after": "a"},)" + std::string(kMake)),
        "in a circle: a after a"));
    CHECK(test::contains(
        refusal(
            R"({"name": "a", "command": "make", "inputs": "balls", "output": "a.vdb", "matrix": {"s": []}})"),
        "has no values"));
    CHECK(test::contains(
        refusal(
            R"({"name": "a", "command": "make", "inputs": "balls", "output": "${s}.vdb", "matrix": {"s": "1-99999", "t": "1-9"}})"),
        "more than 100000 jobs"));
    CHECK(test::contains(
        refusal(R"({"name": "a", "command": "make", "inputs": "balls", "output": "j.json"})"), "job a"));
}

TEST_CASE("fingerprintOf: what a result depends on, and nothing else", "[tools][property]") {
    const test::TemporaryFolder folder;
    folder.write("a.vdb", "1");
    const auto print = [&](const std::string& options, const std::string& output = "b.vdb") {
        FileHashes hashes;
        const Plan plan =
            planOf(folder, R"({"name": "x", "command": "synth", "inputs": "a.vdb", "output": ")" + output +
                               R"(", "options": {)" + options + "}}");
        return fingerprintOf(plan, plan.jobs[0], hashes);
    };
    const std::string first = print(R"("size": "2x,1x,1x")");
    CHECK(print(R"("size": "2x,1x,1x", "threads": 3, "verbose": true, "max-memory": "1G", "drift": 0)") ==
          first);
    CHECK(print(R"("size": "2.0x,1x,1x")") == first);
    CHECK(print(R"("size": "2x,1x,1x", "seed": 2)") != first);
    CHECK(print(R"("size": "2x,1x,1x", "block": 6)") != first);
    CHECK(print(R"("size": "2x,1x,1x")", "c.vdb") != first);
    folder.write("a.vdb", "2");
    CHECK(print(R"("size": "2x,1x,1x")") != first);
}

TEST_CASE("Manifest: what was put comes back, a damaged one is said", "[tools]") {
    const test::TemporaryFolder folder;
    int warnings = 0;
    RunContext ctx;
    ctx.onMessage = [&](MessageLevel level, const std::string&) {
        warnings += level == MessageLevel::Warning;
    };
    Manifest manifest(folder.path("m.json"), ctx);
    CHECK(manifest.find("a") == nullptr);
    manifest.put("a", {"f", {{"b.vdb", "hash"}}, 1.5, 7});
    manifest.save();
    const Manifest again(folder.path("m.json"), ctx);
    REQUIRE(again.find("a"));
    CHECK(again.find("a")->outputs.at("b.vdb") == "hash");
    CHECK(again.find("a")->peakBytes == 7);
    CHECK(warnings == 0);
    for (const std::string text :
         {"", "{", "[]", "{\"format\": 9, \"jobs\": {}}", "{\"format\": 1, \"jobs\": {\"a\": 3}}"}) {
        folder.write("m.json", text);
        CHECK(Manifest(folder.path("m.json"), ctx).find("a") == nullptr);
    }
    CHECK(warnings == 5);
    CHECK(test::thrownBy([&] { Manifest(folder.path("no/m.json"), ctx).save(); }).code == int(ErrorCode::Io));
}

TEST_CASE("Manifest: another format and another version of the program are said, each in one line",
          "[tools]") {
    const test::TemporaryFolder folder;
    std::vector<std::pair<MessageLevel, std::string>> said;
    RunContext ctx;
    ctx.onMessage = [&](MessageLevel level, const std::string& text) { said.emplace_back(level, text); };
    const std::string path = folder.write("m.json", R"({"format": 2, "version": "9.0.0", "jobs": {}})");
    CHECK(Manifest(path, ctx).find("a") == nullptr);
    REQUIRE(said.size() == 1);
    CHECK(said[0].first == MessageLevel::Warning);
    CHECK(said[0].second ==
          path +
              ": is of format 2, written by vdb_synth 9.0.0; this version reads format 1: it is "
              "made anew and all jobs run");
    said.clear();
    folder.write("m.json", R"({"format": 1, "version": "0.0.1", "jobs": {}})");
    CHECK(Manifest(path, ctx).find("a") == nullptr);
    REQUIRE(said.size() == 1);
    CHECK(said[0].first == MessageLevel::Note);
    CHECK(said[0].second ==
          path + ": was written by vdb_synth 0.0.1; with " + cli::kVersion + " all jobs run again");
    said.clear();
    Manifest(path, ctx).save();
    said.clear();
    CHECK(Manifest(path, ctx).find("a") == nullptr);
    CHECK(said.empty());
}

TEST_CASE("isCurrent: outputs by their content", "[tools]") {
    const test::TemporaryFolder folder;
    folder.write("m.vdb", "made");
    const Plan plan = planOf(folder, kMake);
    FileHashes hashes;
    Manifest manifest(folder.path("manifest.json"), {});
    CHECK_FALSE(isCurrent(plan, plan.jobs[0], manifest, hashes));
    const std::string print = fingerprintOf(plan, plan.jobs[0], hashes);
    manifest.put("m", {print, {{"m.vdb", hashes.of(folder.path("m.vdb"))}}, 1, 1});
    CHECK(isCurrent(plan, plan.jobs[0], manifest, hashes));
    folder.write("m.vdb", "else");
    FileHashes fresh;
    CHECK_FALSE(isCurrent(plan, plan.jobs[0], manifest, fresh));
    manifest.put("m", {"other", {{"m.vdb", fresh.of(folder.path("m.vdb"))}}, 1, 1});
    CHECK_FALSE(isCurrent(plan, plan.jobs[0], manifest, fresh));
    manifest.put("m", {print, {}, 1, 1});
    CHECK_FALSE(isCurrent(plan, plan.jobs[0], manifest, fresh));
}

TEST_CASE("referredFiles: materials, pictures and buffers", "[tools]") {
    const test::TemporaryFolder folder;
    for (const char* name : {"a b.png", "c.png", "x.bin", "t%.png"}) folder.write(name, "");
    folder.write("m.mtl", "newmtl a\n  map_Kd a b.png\r\nmap_Bump -bm 0.5 c.png\nmap_d missing.png\n");
    const std::vector<std::string> found = referredFiles(folder.write("m.obj", "mtllib m.mtl\nv 0 0 0\n"));
    CHECK(found ==
          std::vector<std::string>{folder.path("a b.png"), folder.path("c.png"), folder.path("m.mtl")});
    CHECK(
        referredFiles(folder.write(
            "g.gltf",
            R"({"buffers": [{"uri": "x.bin"}, {"uri" : "data:;base64,AA"}], "images": [{"uri": "t%25.png"}, {"uri": "../o"}]})")) ==
        std::vector<std::string>{folder.path("t%.png"), folder.path("x.bin")});
    CHECK(referredFiles(folder.write("bad.gltf", "\"uri\"")).empty());
    CHECK(referredFiles(folder.path("missing.obj")).empty());
    CHECK(referredFiles(folder.path("m.vdb")).empty());
}

TEST_CASE("statusPage: a row a job, all text escaped", "[tools]") {
    const test::TemporaryFolder folder;
    const Plan plan =
        planOf(folder, std::string(kMake) + R"(,{"name": "i", "command": "info", "inputs": "m.vdb"})");
    std::vector<JobStatus> status(2);
    status[0] = {JobState::Failed, 1.25, 3000000, "<script>\"&\x1b", {folder.write("p.png", "PNG")}};
    std::map<std::string, std::string> pictures;
    const std::string page = statusPage(plan, status, pictures);
    CHECK(test::contains(page, "&lt;script&gt;&quot;&amp;?"));
    CHECK(test::contains(page, "base64,UE5H"));
    CHECK(test::contains(page, "1 waiting, 1 failed"));
    CHECK(test::contains(page, "http-equiv=\"refresh\""));
    status[1].state = JobState::Current;
    status[0].pictures = {folder.path("missing.png")};
    const std::string last = statusPage(plan, status, pictures);
    CHECK_FALSE(test::contains(last, "refresh"));
    CHECK_FALSE(test::contains(last, "<img"));
}

TEST_CASE("errorIn: the last line that says error, else the last", "[tools]") {
    const test::TemporaryFolder folder;
    CHECK(errorIn(folder.write(
              "a.log",
              "$ vdb_synth --x=error: 1\nvdb_synth: note\nvdb_synth info: error: a.vdb: bad\nlast\n")) ==
          "a.vdb: bad");
    CHECK(errorIn(folder.write("b.log", "one\ntwo\n\n")) == "two");
    CHECK(errorIn(folder.path("missing.log")).empty());
}
