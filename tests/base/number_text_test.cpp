#include "libvdbsynth/base/number_text.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <limits>

#include "libvdbsynth/base/random.h"
#include "tests/support/comma_locale.h"

using namespace vdbsynth;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

template <typename Real>
Real parsed(const std::string& word) {
    Real value = 0;
    REQUIRE(parseReal(word, value));
    return value;
}

}  // namespace

TEST_CASE("parseReal: a word is a number as a whole or not at all", "[base][fast]") {
    CHECK(parsed<double>("0.5") == 0.5);
    CHECK(parsed<double>("+1e3") == 1000);
    CHECK(parsed<double>("-.25") == -0.25);
    CHECK(parsed<double>("7.") == 7);
    CHECK(parsed<float>("16777217") == 16777216.f);
    for (const char* word :
         {"", " 1", "1 ", "1,5", "1.5.2", "+", "-", "+-1", "--1", "e5", "1e", "0x10", "1f", "one"}) {
        double value = 42;
        INFO("\"" << word << "\"");
        CHECK_FALSE(parseReal(word, value));
        CHECK_FALSE(parseAnyReal(word, value));
        CHECK(value == 42);
    }
}

TEST_CASE("parseReal: what is not finite is refused, what is too small is zero", "[base][fast]") {
    for (const char* word : {"nan", "-inf", "INF", "1e999", "-1e400", "1e99999999999999999999"}) {
        double value = 42;
        INFO(word);
        CHECK_FALSE(parseReal(word, value));
        CHECK(value == 42);
        CHECK(parseAnyReal(word, value));
        CHECK_FALSE(std::isfinite(value));
    }
    CHECK(parsed<double>("1e-999") == 0);
    CHECK(parsed<double>("1e-99999999999999999999") == 0);
    CHECK(std::signbit(parsed<double>("-1e-999")));
    CHECK(parsed<double>("0." + std::string(500, '0') + "1") == 0);
    CHECK(parsed<double>("4.9e-324") == std::numeric_limits<double>::denorm_min());
    float small = 1;
    CHECK(parseReal("1e-60", small));
    CHECK(small == 0);
    CHECK_FALSE(parseReal("1e39", small));
    CHECK(parseAnyReal("-1e39", small));
    CHECK(small == -std::numeric_limits<float>::infinity());
    double large = 0;
    CHECK(parseAnyReal(std::string(400, '9'), large));
    CHECK(large == kInfinity);
}

TEST_CASE("parseWhole: a number that does not fit its type is refused, not wrapped", "[base][fast]") {
    int value = 42;
    CHECK(parseWhole("-2147483648", value));
    CHECK(value == std::numeric_limits<int>::min());
    CHECK(parseWhole("+7", value));
    CHECK(value == 7);
    for (const char* word : {"2147483648", "4294967297", "", "+", "+-7", "1.0", "1e3", " 1", "0x1"}) {
        INFO("\"" << word << "\"");
        CHECK_FALSE(parseWhole(word, value));
        CHECK(value == 7);
    }
    long long wide = 0;
    CHECK(parseWhole("9223372036854775807", wide));
    CHECK(wide == std::numeric_limits<long long>::max());
    CHECK_FALSE(parseWhole("9223372036854775808", wide));
    long same = 0;
    CHECK(parseWhole("-12", same));
    CHECK(same == -12);
}

TEST_CASE("exactText: every number reads back as the same bits", "[base][property]") {
    CHECK(exactText(0.1) == "0.1");
    CHECK(exactText(0.1f) == "0.1");
    CHECK(exactText(-0.0) == "-0");
    CHECK(exactText(3.0) == "3");
    CHECK(exactText(kInfinity) == "inf");
    for (std::uint64_t i = 0; i < 20000; ++i) {
        Random random(5, i);
        const std::uint64_t bits = std::uint64_t(random.bits()) << 32 | random.bits();
        double value = 0, back = 0;
        std::memcpy(&value, &bits, sizeof value);
        if (!std::isfinite(value)) continue;
        const bool read = parseReal(exactText(value), back);
        if (!read || std::memcmp(&back, &value, sizeof value) != 0) FAIL(exactText(value));
        float narrow = 0, narrowBack = 0;
        std::memcpy(&narrow, &bits, sizeof narrow);
        if (!std::isfinite(narrow)) continue;
        if (!parseReal(exactText(narrow), narrowBack) ||
            std::memcmp(&narrow, &narrowBack, sizeof narrow) != 0)
            FAIL(exactText(narrow));
    }
}

TEST_CASE("roundedText, fixedText: print as C's %g and %f do", "[base][oracle]") {
    for (double value : {0.0, -1.5, 1234567.0, 0.000012345, 1e300, -2.5e-7, 999999.5, 3.0, kInfinity}) {
        for (int digits = 1; digits <= 17; ++digits) {
            char expected[400];
            std::snprintf(expected, sizeof expected, "%.*g", digits, value);
            CHECK(roundedText(value, digits) == expected);
            std::snprintf(expected, sizeof expected, "%.*f", digits, value);
            CHECK(fixedText(value, digits) == expected);
        }
    }
    CHECK(fixedText(std::numeric_limits<double>::lowest(), 17).size() == 328);
}

TEST_CASE("number_text: a host with a decimal comma changes nothing", "[base][property]") {
    const test::CommaLocale host;
    if (!host.changesC()) WARN("no C locale with a decimal comma could be made here: only C++'s is tested");
    CHECK(parsed<double>("0.5") == 0.5);
    CHECK(exactText(1234567.5) == "1234567.5");
    CHECK(roundedText(12345.678, 7) == "12345.68");
    CHECK(fixedText(12345.678, 1) == "12345.7");
    double value = 0;
    CHECK_FALSE(parseReal("0,5", value));
}

TEST_CASE("countText: one of something is not several", "[base][hand]") {
    CHECK(countText(0, "point") == "0 points");
    CHECK(countText(1, "open edge") == "1 open edge");
    CHECK(countText(12, "row") == "12 rows");
}
