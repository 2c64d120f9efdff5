// What files hold by their extensions, apart from what reads them: plans of jobs ask without it.
#include "libvdbsynth/pipeline/convert/model.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/mesh_file.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/io/point_file.h"
#include "libvdbsynth/io/raster_file.h"

namespace vdbsynth {

bool isMeshPath(const std::string& path) {
    MeshFormat format{};
    return meshFormatOf(path, format);
}

bool isModelPath(const std::string& path) {
    return readExtensionOf(path) == "vdb" || isMeshPath(path) || isPointPath(path) || isRasterPath(path);
}

void requireModelPath(const std::string& path) {
    if (isModelPath(path)) return;
    for (const char* archive : {"zip", "npz", "7z", "rar", "tar", "tgz", "xz", "bz2", "zst"})
        if (extensionOf(path) == archive)
            throw Error(ErrorCode::InvalidOption,
                        path + ": is an archive; unpack it and name one of its files (.gz is read directly)");
    for (const char* part : {"hdr", "img"})
        if (readExtensionOf(path) == part)
            throw Error(ErrorCode::InvalidOption,
                        path + ": is one of a pair of files (Analyze 7.5 or NIfTI); convert it to one .nii");
    for (const char* scan : {"las", "laz", "e57", "ptx", "copc"})
        if (readExtensionOf(path) == scan)
            throw Error(ErrorCode::InvalidOption,
                        path + ": ." + scan +
                            " files are not read; save the points as .ply, .pcd or .xyz, for example with "
                            "CloudCompare or PDAL");
    throw Error(ErrorCode::InvalidOption,
                path +
                    ": unknown extension; models are .vdb, meshes .obj, .ply, .stl, .off, .gltf, .glb, .3mf, "
                    ".mesh, points .ply, " +
                    kPointExtensions + ", " + kRasterExtensions + ", each also with .gz");
}

}  // namespace vdbsynth
