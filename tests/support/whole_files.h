#pragma once
#include "libvdbsynth/io/mesh_file.h"
#include "libvdbsynth/io/raster_file.h"
#include "tests/support/gltf_files.h"
#include "tests/support/makers.h"
#include "tests/support/raster_files.h"
#include "tests/support/temporary_folder.h"

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
        {"a.obj", MeshFormat::Obj}, {"a.ply", MeshFormat::Ply}, {"a.stl", MeshFormat::Stl},
        {"a.off", MeshFormat::Off}, {"a.glb", MeshFormat::Glb}, {"a.gltf", MeshFormat::Gltf}};
    for (const auto& [name, format] : formats) {
        writeMesh(folder.path(name), format, mesh);
        files[name] = contentOf(folder.path(name));
    }
    files["b.glb"] = posedGltf().bytes();
    files["c.glb"] = pointsGltf().bytes();
    files["a.mesh"] =
        "MeshVersionFormatted 1\nDimension 3\nVertices 3\n0 0 0 0\n1 0 0 0\n0 1 0 0\nTriangles 1\n1 2 3 "
        "0\nEnd\n";
    files["a.xyz"] = "0 0 0 0 0 1\n1 0 0 0 0 1\n";
    files["a.pcd"] =
        "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 2\nHEIGHT 1\nPOINTS 2\nDATA "
        "binary\n" +
        std::string(24, '\0');
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
