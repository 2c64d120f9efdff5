#include "libvdbsynth/vdb/read/grid_names.h"
#include "libvdbsynth/vdb/grid_kinds.h"

#include <catch2/catch.hpp>

using namespace vdbsynth;

namespace {

std::vector<GridPtr> grids(const std::vector<std::string>& names) {
    openvdb::initialize();
    std::vector<GridPtr> all;
    for (const std::string& name : names) {
        all.push_back(openvdb::FloatGrid::create());
        all.back()->setName(name);
    }
    return all;
}

}  // namespace

TEST_CASE("uniqueNamesOf: a number where several grids have a name", "[vdb][fast]") {
    CHECK(uniqueNamesOf(grids({"a", "b", "a", ""})) == std::vector<std::string>{"a[0]", "b", "a[1]", ""});
    CHECK(uniqueNamesOf({}).empty());
}

TEST_CASE("gridNamed: by name, by number, by a name that looks like a number", "[vdb][fast]") {
    const std::vector<GridPtr> all = grids({"a", "b", "a", "b[1]"});
    std::size_t several = 0;
    CHECK(gridNamed(all, "a", &several) == all[0]);
    CHECK(several == 2);
    CHECK(gridNamed(all, "a[1]", &several) == all[2]);
    CHECK(several == 1);
    CHECK(gridNamed(all, "b[1]") == all[3]);
    CHECK(gridNamed(all, "b[0]") == all[1]);
    CHECK_FALSE(gridNamed(all, "a[2]", &several));
    CHECK(several == 0);
    CHECK_FALSE(gridNamed(all, "[0]"));
    CHECK_FALSE(gridNamed({}, "a"));
}

TEST_CASE("listOf: names and types, without raw bytes and without end", "[vdb][fast]") {
    CHECK(listOf(grids({"a", "a", "c\x01\xff"})) == "a[0] (float), a[1] (float), c?? (float)");
    CHECK(listOf({}) == "no grids");
    const std::string many = listOf(grids(std::vector<std::string>(100, "x")));
    CHECK(many.find("and 70 more") != std::string::npos);
}
