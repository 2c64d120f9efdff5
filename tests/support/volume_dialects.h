#pragma once
#include "tests/support/raster_files.h"

#include <map>
#include <string>

namespace vdbsynth::test {

/// Small files of volumes in dialects that wholeFiles does not show, by kind.
inline std::multimap<std::string, std::string> volumeDialects() {
    const std::string
        image = "<VTKFile type=\"ImageData\"><ImageData WholeExtent=\"3 5 0 1 0 0\" Origin=\"1 2 3\" ",
        vectors =
            "<DataArray Name=\"u\" type=\"Float32\" NumberOfComponents=\"2\" "
            "format=\"ascii\">1 2 3 4</DataArray>",
        cells = "<DataArray Name=\"c\" type=\"Int8\" format=\"ascii\">1</DataArray>";
    const auto piece = [&](const std::string& extent) {
        return "<Piece Extent=\"" + extent + "\"><PointData Vectors=\"u\">" + vectors +
               "</PointData><CellData>" + cells + "</CellData></Piece>";
    };
    std::string frames = nifti(2, 1, 1, "abcd", {0, -1, 0, 5, 0.6f, 0, 0.8f, 0, 0.8f, 0, -0.6f, 0});
    frames[40] = 4;
    frames[48] = 2;
    return {{"vti", image + "Direction=\"0 -1 0 0.6 0 0.8 0.8 0 -0.6\">" + piece("3 4 0 1 0 0") +
                        piece("4 5 0 1 0 0") + "</ImageData></VTKFile>"},
            {"nii", frames},
            {"npy", npy("|u1", "(2, 2, 1, 2)", "abcdefgh")},
            {"npy", npy(">f4", "(1, 1, 1, 2, 2)", std::string(16, '\0'), true)},
            {"sgems", "grid (2x1x2)\n2\na\nb\n1 2\n3 4\n5 6\n-9966699 nan\n"},
            {"sgems", "2 1 1 0 0 -5 10 10 2\n1\nv\n1\n2\n"},
            {"inr",
             "#INRIMAGE-4#{\nXDIM=1\nYDIM=1\nZDIM=1\nVDIM=2\nTYPE=signed fixed\nPIXSIZE=16 bits\nCPU=sun\n"
             "VX=0.5\nTX=-3\nRX=1\n##}\nabcd"}};
}

}  // namespace vdbsynth::test
