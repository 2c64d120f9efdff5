// Writes small whole files of every kind into FOLDER/KIND/, where the fuzz targets begin. Usage: fuzz_seeds
// FOLDER
#include "tests/support/tiff_maker.h"
#include "tests/support/volume_dialects.h"
#include "tests/support/whole_files.h"

#include <filesystem>
#include <fstream>
#include <string>

namespace {

// Dialects of TIFF: turned, packed, of channels and of an orientation, ImageJ's and OME's.
std::vector<std::string> tiffDialects() {
    using namespace vdbsynth;
    test::TiffMaker maker, turned{/* bigEndian= */ true};
    const auto described = [&](const std::string& text) {
        test::TiffMaker::Page page{2, 1, 8, "ab"};
        page.fields = {test::TiffMaker::text(270, text), maker.rational(282, 1, 10),
                       maker.rational(283, 1, 10)};
        return maker.file({page, {2, 1, 8, "cd"}, {2, 1, 8, "ef"}, {2, 1, 8, "gh"}});
    };
    test::TiffMaker::Page packed{3, 2, 12, "abcdefghij"};
    packed.fields = {turned.shorts(274, {6})};
    test::TiffMaker::Page placed{1, 1, 8, "a"};
    placed.fields = {maker.doubles(34264, {30, 1, 0, 0, 1, -30, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1})};
    return {turned.file({packed}), maker.file({placed, {4, 4, 8, std::string(16, 'a')}, {2, 2, 8, "abcd"}}),
            described("ImageJ=1.53\nimages=4\nchannels=2\nslices=2\nspacing=3\nunit=um\ncf=0\nc0=-1\nc1=2\n"),
            described("<OME><Pixels DimensionOrder=\"XYCZT\" SizeC=\"2\" SizeZ=\"2\" SizeT=\"1\" "
                      "PhysicalSizeX=\"1\"><TiffData IFD=\"0\" PlaneCount=\"4\"/></Pixels></OME>"),
            described("{\"shape\": [2, 2, 1, 2], \"axes\": \"CZYX\"}")};
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    const vdbsynth::test::TemporaryFolder folder;
    for (const auto& [name, content] : vdbsynth::test::wholeFiles(folder)) {
        const std::filesystem::path file(name),
            kind = std::filesystem::path(argv[1]) / file.extension().string().substr(1);
        std::filesystem::create_directories(kind);
        std::ofstream(kind / file.stem(), std::ios::binary) << content;
    }
    std::filesystem::create_directories(std::filesystem::path(argv[1]) / "model");
    std::ofstream(std::filesystem::path(argv[1]) / "model" / "full") << vdbsynth::test::fullThreemfModel();
    std::size_t number = 0;
    for (const auto& [kind, content] : vdbsynth::test::volumeDialects()) {
        const std::filesystem::path name =
            std::filesystem::path(argv[1]) / kind / ("dialect" + std::to_string(++number));
        std::ofstream(name, std::ios::binary) << content;
    }
    for (const std::string& content : tiffDialects())
        std::ofstream(std::filesystem::path(argv[1]) / "tif" / ("dialect" + std::to_string(number++)),
                      std::ios::binary)
            << content;
    std::filesystem::create_directories(std::filesystem::path(argv[1]) / "jobs");
    for (const char* name : {"batch.json", "batch.yaml"})
        std::filesystem::copy_file(std::filesystem::path(VDBSYNTH_SOURCE_DIR) / "docs/examples" / name,
                                   std::filesystem::path(argv[1]) / "jobs" / name,
                                   std::filesystem::copy_options::overwrite_existing);
    return 0;
}
