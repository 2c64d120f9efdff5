#pragma once
#include <clocale>
#include <cstdlib>
#include <locale>
#include <string>

#include "tests/support/temporary_folder.h"

namespace vdbsynth::test {

/// The locale of a host program in German while it lives: C's and C++'s, with a decimal comma and, in C++,
/// dots between thousands. C's is made with localedef where the machine has none.
class CommaLocale {
public:
    CommaLocale() : mC(std::setlocale(LC_ALL, nullptr)) {
        mCpp = std::locale::global(std::locale(std::locale::classic(), new German));
        if (std::setlocale(LC_ALL, "de_DE.UTF-8")) return;
        const std::string folder = mFolder.path("locales");
        if (std::system(("mkdir " + folder + " && localedef -i de_DE -f UTF-8 " + folder +
                         "/de_DE.UTF-8 >/dev/null 2>&1")
                            .c_str()) != 0)
            return;
        ::setenv("LOCPATH", folder.c_str(), 1);
        std::setlocale(LC_ALL, "de_DE.UTF-8");
        ::unsetenv("LOCPATH");
    }
    ~CommaLocale() {
        std::locale::global(mCpp);
        std::setlocale(LC_ALL, mC.c_str());
    }
    CommaLocale(const CommaLocale&) = delete;
    CommaLocale& operator=(const CommaLocale&) = delete;

    /// False where no C locale with a comma could be had: printf and strtod then keep their point.
    bool changesC() const { return std::string(std::localeconv()->decimal_point) == ","; }

private:
    struct German : std::numpunct<char> {
        char do_decimal_point() const override { return ','; }
        char do_thousands_sep() const override { return '.'; }
        std::string do_grouping() const override { return "\3"; }
    };

    TemporaryFolder mFolder;
    std::string mC;
    std::locale mCpp;
};

}  // namespace vdbsynth::test
