// Writes a small whole file of every kind into FOLDER/KIND/, where the fuzz targets begin. Usage: fuzz_seeds
// FOLDER
#include "tests/support/whole_files.h"

#include <filesystem>
#include <fstream>

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    const vdbsynth::test::TemporaryFolder folder;
    for (const auto& [name, content] : vdbsynth::test::wholeFiles(folder)) {
        const std::filesystem::path kind =
            std::filesystem::path(argv[1]) / std::filesystem::path(name).extension().string().substr(1);
        std::filesystem::create_directories(kind);
        std::ofstream(kind / name, std::ios::binary) << content;
    }
    return 0;
}
