#include "libvdbsynth/patch/barred_columns.h"

#include "tests/support/contexts.h"

#include <catch2/catch.hpp>

using namespace vdbsynth;

TEST_CASE("BarredColumns: says of every place what counting says") {
    const PatchLattice lattice{1, 7, 5, 2};
    std::vector<std::uint8_t> barred(35, 0);
    barred[lattice.column(2, 3)] = 1;
    barred[lattice.column(6, 0)] = 200;
    const BarredColumns columns(lattice, barred);
    for (int nx = 1; nx <= 7; ++nx)
        for (int ny = 1; ny <= 5; ++ny) {
            std::size_t free = 0;
            for (int i = 0; i + nx <= 7; ++i)
                for (int j = 0; j + ny <= 5; ++j) {
                    bool any = false;
                    for (int a = i; a < i + nx; ++a)
                        for (int b = j; b < j + ny; ++b) any = any || barred[lattice.column(a, b)];
                    CHECK(columns.any(i, j, nx, ny) == any);
                    free += any ? 0 : 1;
                }
            CHECK(columns.places(nx, ny) == free);
        }
}

TEST_CASE("BarredColumns: nothing barred, all barred, larger than the lattice, and what is refused") {
    const PatchLattice lattice{1, 3, 3, 1};
    CHECK(BarredColumns(lattice, std::vector<std::uint8_t>(9, 0)).places(2, 2) == 4);
    CHECK(BarredColumns(lattice, std::vector<std::uint8_t>(9, 1)).places(1, 1) == 0);
    CHECK(BarredColumns(lattice, std::vector<std::uint8_t>(9, 0)).places(4, 1) == 0);
    CHECK_THROWS_WITH(BarredColumns(lattice, std::vector<std::uint8_t>(8, 0)),
                      Catch::Contains("differ in number"));
}
