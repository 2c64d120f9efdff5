// Writes small whole files of every kind into FOLDER/KIND/, where the fuzz targets begin. Usage: fuzz_seeds
// FOLDER
#include "tests/support/volume_dialects.h"
#include "tests/support/whole_files.h"

#include <filesystem>
#include <fstream>
#include <string>

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    const vdbsynth::test::TemporaryFolder folder;
    for (const auto& [name, content] : vdbsynth::test::wholeFiles(folder)) {
        const std::filesystem::path file(name),
            kind = std::filesystem::path(argv[1]) / file.extension().string().substr(1);
        std::filesystem::create_directories(kind);
        std::ofstream(kind / file.stem(), std::ios::binary) << content;
    }
    std::size_t number = 0;
    for (const auto& [kind, content] : vdbsynth::test::volumeDialects()) {
        const std::filesystem::path name =
            std::filesystem::path(argv[1]) / kind / ("dialect" + std::to_string(++number));
        std::ofstream(name, std::ios::binary) << content;
    }
    return 0;
}
