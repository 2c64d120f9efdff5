#include "libvdbsynth/search/block_index_file.h"

#include <catch2/catch.hpp>

#include "tests/support/makers.h"

#include <filesystem>
#include <fstream>

using namespace vdbsynth;
namespace fs = std::filesystem;

namespace {

// A folder of its own that goes with the test.
struct Folder {
    explicit Folder(const std::string& name) : path(fs::temp_directory_path() / ("vdbsynth_" + name)) {
        fs::remove_all(path);
        fs::create_directory(path);
    }
    ~Folder() { fs::remove_all(path); }
    std::vector<fs::path> files() const {
        std::vector<fs::path> found;
        for (const auto& entry : fs::directory_iterator(path)) found.push_back(entry.path());
        return found;
    }
    fs::path path;
};

std::vector<BlockMatch> answers(const BlockIndex& index, const BrickField& field) {
    std::vector<float> samples(std::size_t(index.block()) * std::size_t(index.block()) *
                               std::size_t(index.block()));
    field.readBox({3, 5, 2}, {index.block(), index.block(), index.block()}, samples.data());
    for (std::size_t i = 0; i < samples.size(); i += 3) samples[i] += 0.2f;
    BlockQuery query;
    query.samples = samples.data();
    return index.match(query, 7);
}

bool same(const std::vector<BlockMatch>& a, const std::vector<BlockMatch>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const BlockMatch& x, const BlockMatch& y) {
        return x.cost == y.cost && x.position == y.position;
    });
}

void setByte(const fs::path& path, std::streamoff at, char value) {
    std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
    file.seekp(at);
    file.put(value);
}

}  // namespace

TEST_CASE("Block index file: what was kept is read and answers the same", "[search]") {
    const Folder folder("index_kept");
    const auto field = std::make_shared<const BrickField>(test::ballsField({40, 32, 36}, 3, 3.f, 2));
    BlockIndexOptions options;
    options.block = 8;
    const std::vector<BlockMatch> expected = answers(BlockIndex::build(field, options), *field);
    options.cacheFolder = folder.path.string();
    std::vector<std::string> said;
    RunContext ctx;
    ctx.onMessage = [&](MessageLevel, const std::string& text) { said.push_back(text); };
    CHECK(same(answers(BlockIndex::build(field, options, ctx), *field), expected));
    REQUIRE(folder.files().size() == 1);
    CHECK(same(answers(BlockIndex::build(field, options, ctx), *field), expected));
    REQUIRE(said.size() == 2);
    CHECK(test::contains(said[0], "will be saved"));
    CHECK(test::contains(said[1], "read from"));
    CHECK(folder.files().size() == 1);
}

TEST_CASE("Block index file: another exemplar, block or mask is another file", "[search]") {
    const BrickField a = test::ballsField({24, 24, 24}, 3, 3.f);
    BrickField b = a;
    const float changed = a.at({5, 6, 7}) + 1e-3f;
    b.writeBox({5, 6, 7}, {1, 1, 1}, &changed);
    const BrickField mask(a.box(), 1.f);
    RunContext one;
    one.threads = 1;
    const std::string name = blockIndexFileName(a, nullptr, 8, {});
    CHECK(name == blockIndexFileName(a, nullptr, 8, one));
    CHECK(name != blockIndexFileName(b, nullptr, 8, {}));
    CHECK(name != blockIndexFileName(a, nullptr, 9, {}));
    CHECK(name != blockIndexFileName(a, &mask, 8, {}));
}

TEST_CASE("Block index file: a damaged or truncated one is refused and made again", "[search]") {
    const Folder folder("index_damaged");
    const auto field = std::make_shared<const BrickField>(test::ballsField({24, 28, 26}, 3, 3.f));
    BlockIndexOptions options;
    options.block = 8;
    options.cacheFolder = folder.path.string();
    const std::vector<BlockMatch> expected = answers(BlockIndex::build(field, options), *field);
    const fs::path file = folder.files().at(0);
    const auto size = std::streamoff(fs::file_size(file));
    std::vector<std::string> said;
    RunContext ctx;
    ctx.onMessage = [&](MessageLevel, const std::string& text) { said.push_back(text); };
    for (std::streamoff at : {std::streamoff(0), std::streamoff(9), std::streamoff(45), size / 2, size - 1}) {
        said.clear();
        setByte(file, at, '\x5a');
        CHECK(same(answers(BlockIndex::build(field, options, ctx), *field), expected));
        REQUIRE(said.size() == 1);
        CHECK(test::contains(said[0], "it is rebuilt"));
    }
    for (std::streamoff length : {std::streamoff(0), std::streamoff(20), size - 4}) {
        fs::resize_file(file, std::uintmax_t(length));
        said.clear();
        CHECK(same(answers(BlockIndex::build(field, options, ctx), *field), expected));
        REQUIRE(said.size() == 1);
    }
    CHECK(std::streamoff(fs::file_size(file)) == size);
}

TEST_CASE("Block index file: one of another format is said by its number, and made again", "[search]") {
    const Folder folder("index_format");
    const auto field = std::make_shared<const BrickField>(test::ballsField({24, 28, 26}, 3, 3.f));
    BlockIndexOptions options;
    options.block = 8;
    options.cacheFolder = folder.path.string();
    const std::vector<BlockMatch> expected = answers(BlockIndex::build(field, options), *field);
    const fs::path file = folder.files().at(0);
    std::vector<std::string> said;
    RunContext ctx;
    ctx.onMessage = [&](MessageLevel, const std::string& text) { said.push_back(text); };
    setByte(file, 7, '3');
    CHECK(same(answers(BlockIndex::build(field, options, ctx), *field), expected));
    CHECK(said == std::vector<std::string>{
                      file.string() + ": is a search index of format 3, of another version of vdb_synth; "
                                      "this one reads format 2; it is rebuilt"});
    said.clear();
    setByte(file, 0, 'x');
    CHECK(same(answers(BlockIndex::build(field, options, ctx), *field), expected));
    CHECK(said == std::vector<std::string>{file.string() + ": is no search index; it is rebuilt"});
}

TEST_CASE("Block index file: a folder that is not there is an error", "[search]") {
    BlockIndexOptions options;
    options.block = 8;
    options.cacheFolder = "/no/such/folder";
    const auto field = std::make_shared<const BrickField>(test::ballsField({24, 28, 26}, 3, 3.f));
    CHECK(test::thrownBy([&] { BlockIndex::build(field, options); }).code == int(ErrorCode::Io));
}
