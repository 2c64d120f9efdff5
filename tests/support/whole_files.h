#pragma once
#include "libvdbsynth/io/mesh_file.h"
#include "libvdbsynth/io/raster_file.h"
#include "tests/support/gltf_files.h"
#include "tests/support/makers.h"
#include "tests/support/raster_files.h"
#include "tests/support/stl_files.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/threemf_files.h"

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace vdbsynth::test {

/// A small whole file of every kind that is read, by name.
inline std::map<std::string, std::string> wholeFiles(const TemporaryFolder& folder) {
    std::map<std::string, std::string> files;
    const Mesh mesh = boxMesh({0, 0, 0}, {1, 2, 3});
    const std::pair<const char*, MeshFormat> formats[] = {
        {"a.obj", MeshFormat::Obj},    {"a.ply", MeshFormat::Ply}, {"a.stl", MeshFormat::Stl},
        {"a.off", MeshFormat::Off},    {"a.glb", MeshFormat::Glb}, {"a.gltf", MeshFormat::Gltf},
        {"a.3mf", MeshFormat::ThreeMf}};
    for (const auto& [name, format] : formats) {
        writeMesh(folder.path(name), format, mesh);
        files[name] = contentOf(folder.path(name));
    }
    files["dialect.obj"] =
        "\xef\xbb\xbf# C:\\a\\\rV 0 0 0 1\rv 1 0 0\rv 1 1 0 # far\rv 0.5 0.25 \\\r0\rv 1.#QNAN 0 0\rv 0 1 "
        "0\rvt 0 0\rvn 0 0 1\r"
        "f 1/ 2// 3/1/ 4/1/1 6//1\rfo -6 -4 6\rl 1 2\rsurf 0 1 0 1 1 2\r";
    // Dialects of these.
    files["ascii.stl"] = asciiStl();
    files["capitals.stl"] =
        "SOLID\r  FACET NORMAL 0 0 1\r OUTER LOOP\r VERTEX 0,5 0 0\r VERTEX 1D0 0 0\r VERTEX 0 1 0\r END "
        "LOOP\r "
        "ENDFACET\rENDSOLID";
    files["count.stl"] = binaryStl(boxFacets(), 0) + "tail";
    files["big.stl"] = binaryStl(boxFacets(), 12, /* bigEndian= */ true);
    files["two.stl"] = binaryStl(boxFacets(), 12) + binaryStl(boxFacets(), 12);
    files["glued.off"] = "OFF3 1 3 0 0 0 1 0 0 0 1 0 3 0 1 2";
    files["colours.off"] =
        "CNOFF\r3 1\r0 0 0 0 0 1 9 9 9\r1 0 0 0 0 1 9 9 9\r0 1 0 0 0 1 9 9 9\r3 0 1 2 255 0 0\r";
    files["long.ply"] =
        "ply\rformat ascii 1.0\relement face 1\rproperty list uchar int corners\relement vertex 3\rproperty "
        "float "
        "x\rproperty double y\rproperty int64 z\rend_header\r3 0 1 2 9 9\r0 0 0\r1 0 0\r0 1 0\r";
    files["big.ply"] =
        "ply\nformat binary_big_endian 1.0\nelement vertex 3\nproperty short x\nproperty short y\nproperty "
        "short "
        "z\nelement tristrips 1\nproperty list uchar uchar vertex_indices\nend_header\n" +
        std::string("\0\0\0\0\0\0\0\1\0\0\0\0\0\0\0\1\0\0\3\0\1\2", 22);
    files["volume.mesh"] =
        "MeshVersionFormatted 2\nDimension 3\nVertices 4\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\nTetrahedra "
        "1\n1 2 3 4 "
        "0\nEnd\n";
    files["b.glb"] = posedGltf().bytes();
    files["c.glb"] = pointsGltf().bytes();
    files["full.3mf"] = fullThreemf();
    files["a.mesh"] =
        "MeshVersionFormatted 1\nDimension 3\nVertices 3\n0 0 0 0\n1 0 0 0\n0 1 0 0\nTriangles 1\n1 2 3 "
        "0\nEnd\n";
    files["a.xyz"] = "0 0 0 0 0 1\n1 0 0 0 0 1\n";
    files["a.pcd"] =
        "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 2\nHEIGHT 1\nPOINTS 2\nDATA "
        "binary\n" +
        std::string(24, '\0');
    files["header.xyz"] = "//X Y Z R G B Heat\r\n0 0 0 255 0 0 0.5\r\n1 0 0 0 255 0 -1\r\n";
    files["decimal.xyz"] = "\"x\";\"y\";\"z\"\n0,5;0;1\n1,25;2;-3,5e-1\n";
    files["counted.xyz"] = "2\n0 0 0 -7 255 0 0\n1 0 0 9 0 255 0\n1\n2 0 0 1 0 0 255\n";
    files["words.xyz"] = "id,x,y,z,kind\n1,0,0,0,tree\n2,1,,0,house\n";
    files["columns.pcd"] =
        "# .PCD v.6\nVERSION .6\nCOLUMNS x y z _ rgb\nSIZE 4 4 4 1 4\nTYPE f f f u f\nCOUNT 1 1 1 3 1\n"
        "POINTS 1\nDATA ascii\n1 2 3 0 0 0 4.2e6\n";
    files["points.npy"] = npy("<f8", "(3, 30)", raw(std::vector<double>(90, 1.5)));
    const std::vector<float> heights{0, 0.25f, 1, 0.5f};
    writeGreyPng(folder.path("a.png"), 2, 2, heights);
    files["a.png"] = contentOf(folder.path("a.png"));
    writeGreyExr(folder.path("a.exr"), 2, 2, heights);
    files["a.exr"] = contentOf(folder.path("a.exr"));
    files["a.pgm"] = pgm(2, 2, 255, "abcd");
    files["a.tif"] = tiff(2, 1, 16, 2, {"abcd", "efgh"}, "-1", {3, 3, 0});
    files["a.npy"] = npy("<f4", "(2, 2)", raw(heights));
    files["a.nii"] = nifti(2, 2, 1, "abcd", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0});
    files["a.vti"] = vti("0 1 0 1 0 0", "", "type=\"UInt8\" format=\"binary\"", "BAAAAAABAgM=");
    files["a.sgems"] = "2 2 1\n1\nv\n1\n2\n3\n4\n";
    std::string header =
        "#INRIMAGE-4#{\nXDIM=2\nYDIM=2\nZDIM=1\nVDIM=1\nTYPE=float\nPIXSIZE=32 bits\nCPU=decm\n";
    header.resize(252, '\n');
    files["a.inr"] = header + "##}\n" + raw(heights);
    if (!sample("textures/embark-1.jpg").empty()) files["a.jpg"] = contentOf(sample("textures/embark-1.jpg"));
    return files;
}

}  // namespace vdbsynth::test
