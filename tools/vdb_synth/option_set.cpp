#include "tools/vdb_synth/option_set.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/vdb/level_set.h"

#include <boost/program_options.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>

namespace po = boost::program_options;

namespace vdbsynth::cli {
namespace {

[[noreturn]] void refuse(const std::string& text) {
    throw Error(ErrorCode::InvalidOption, text);
}

std::size_t editDistance(const std::string& a, const std::string& b) {
    std::vector<std::size_t> row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t above = row[j];
            row[j] = std::min({row[j] + 1, row[j - 1] + 1, diagonal + (a[i - 1] == b[j - 1] ? 0 : 1)});
            diagonal = above;
        }
    }
    return row[b.size()];
}

bool parseNumber(const std::string& text, double& value) {
    char* end = nullptr;
    value = std::strtod(text.c_str(), &end);
    return !text.empty() && *end == 0 && std::isfinite(value) &&
           text.find_first_of("xXpP ") == std::string::npos;
}

// The shortest text that reads back as the same number.
std::string exact(double value) {
    char text[32];
    return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%g", value);
    return text;
}

po::options_description describe(const std::vector<Option>& options) {
    po::options_description description;
    for (const Option& option : options) {
        const std::string names = option.letter ? option.name + "," + option.letter : option.name;
        if (option.argument.empty())
            description.add_options()(names.c_str(), "");
        else
            description.add_options()(names.c_str(), po::value<std::vector<std::string>>(), "");
    }
    description.add_options()("inputs", po::value<std::vector<std::string>>(), "");
    return description;
}

// "--option" whose value may be left out becomes "--option=" or "--option=value".
std::vector<std::string> bindOptionalValues(const std::vector<Option>& options,
                                            const std::vector<std::string>& words) {
    std::vector<std::string> bound;
    for (std::size_t i = 0; i < words.size(); ++i) {
        const auto optional = std::find_if(options.begin(), options.end(), [&](const Option& o) {
            return !o.ending.empty() && (words[i] == "--" + o.name || words[i] == "-" + o.name);
        });
        bound.push_back(words[i]);
        if (optional == options.end()) continue;
        const std::string& ending = optional->ending;
        const std::string next = i + 1 < words.size() ? words[i + 1] : "";
        const bool hasValue = next.size() > ending.size() &&
                              next.compare(next.size() - ending.size(), ending.size(), ending) == 0;
        bound.back() += "=" + (hasValue ? words[++i] : kNoValue);
    }
    return bound;
}

// Boost takes "-.obj", the name of a stream, for an option: it goes by with another first letter.
constexpr char kStreamMark = '\x01';

std::vector<std::string> hideStreams(std::vector<std::string> words) {
    for (std::string& word : words)
        if (word.size() > 2 && word.compare(0, 2, "-.") == 0 &&
            std::isalpha(static_cast<unsigned char>(word[2])))
            word[0] = kStreamMark;
    return words;
}

std::vector<std::string> shownStreams(std::vector<std::string> words) {
    for (std::string& word : words)
        if (!word.empty() && word[0] == kStreamMark) word[0] = '-';
    return words;
}

std::string dashed(std::string name) {
    while (!name.empty() && name[0] == '-') name.erase(0, 1);
    return name.substr(0, name.find('='));
}

}  // namespace

std::string nearestName(const std::string& word, const std::vector<std::string>& names) {
    std::string best;
    std::size_t distance = std::max<std::size_t>(2, word.size() / 3) + 1;
    for (const std::string& name : names) {
        const std::size_t d = editDistance(word, name);
        if (d < distance) {
            distance = d;
            best = name;
        }
    }
    return best;
}

std::string Arguments::text(const std::string& name, const std::string& fallback) const {
    const auto it = values.find(name);
    const std::string& value = it == values.end() || it->second.empty() ? fallback : it->second.front();
    if (!value.empty() && mNormalised.count(name) == 0) note(name, value);
    return value;
}

std::vector<std::string> Arguments::all(const std::string& name) const {
    const auto it = values.find(name);
    return it == values.end() ? std::vector<std::string>{} : it->second;
}

int Arguments::whole(const std::string& name, int fallback, int low, int high) const {
    if (!has(name)) return note(name, std::to_string(fallback)), fallback;
    double value = 0;
    const bool ok =
        parseNumber(text(name), value) && value == std::floor(value) && value >= low && value <= high;
    requireOption(ok, name, text(name),
                  "a whole number from " + std::to_string(low) + " to " + std::to_string(high));
    note(name, std::to_string(int(value)));
    return int(value);
}

std::uint64_t Arguments::wide(const std::string& name, std::uint64_t fallback) const {
    if (!has(name)) return fallback;
    const std::string given = text(name);
    requireOption(
        !given.empty() && given.size() <= 19 && given.find_first_not_of("0123456789") == std::string::npos,
        name, given, "a whole number from 0 to 9999999999999999999");
    return std::strtoull(given.c_str(), nullptr, 10);
}

double Arguments::real(const std::string& name, double fallback, double low, double high) const {
    if (!has(name)) return note(name, exact(fallback)), fallback;
    double value = 0;
    const bool ok = parseNumber(text(name), value) && value >= low && value <= high;
    requireOption(ok, name, text(name), "a number from " + number(low) + " to " + number(high));
    note(name, exact(value));
    return value;
}

std::array<double, 3> Arguments::triple(const std::string& name,
                                        const std::array<double, 3>& fallback) const {
    if (!has(name)) return fallback;
    std::array<double, 3> result{};
    std::string rest = text(name);
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t comma = rest.find(',');
        const bool last = i == 2;
        requireOption(last == (comma == std::string::npos) && parseNumber(rest.substr(0, comma), result[i]),
                      name, text(name), "three numbers with commas, for example 1,2,3");
        if (!last) rest = rest.substr(comma + 1);
    }
    note(name, exact(result[0]) + "," + exact(result[1]) + "," + exact(result[2]));
    return result;
}

IndexBox Arguments::box(const std::string& name) const {
    IndexBox box;
    requireOption(parseBox(text(name), box), name, text(name),
                  "six whole numbers i,j,k,I,J,K, every minimum at most its maximum");
    note(name, boxText(box));
    return box;
}

std::uint64_t Arguments::bytes(const std::string& name, std::uint64_t fallback) const {
    if (!has(name)) return fallback;
    std::string given = text(name);
    double unit = 1;
    if (!given.empty() && (given.back() == 'B' || given.back() == 'b')) given.pop_back();
    const std::string letters = "KMGT";
    if (!given.empty()) {
        const std::size_t power = letters.find(char(std::toupper(static_cast<unsigned char>(given.back()))));
        if (power != std::string::npos) {
            unit = std::pow(1000.0, double(power + 1));
            given.pop_back();
        }
    }
    double value = 0;
    requireOption(parseNumber(given, value) && value * unit >= 1e6 && value * unit <= 1e15, name, text(name),
                  "at least 1M, for example 4G");
    return std::uint64_t(value * unit);
}

Arguments parseArguments(const std::vector<Option>& options, const std::vector<std::string>& words) {
    std::vector<std::string> names;
    for (const Option& option : options) names.push_back(option.name);
    const po::options_description description = describe(options);
    po::positional_options_description positional;
    positional.add("inputs", -1);
    namespace style = po::command_line_style;
    const int flags = (style::unix_style | style::allow_long_disguise) & ~style::allow_guessing;
    Arguments arguments;
    try {
        const po::parsed_options parsed =
            po::command_line_parser(hideStreams(bindOptionalValues(options, words)))
                .options(description)
                .positional(positional)
                .style(flags)
                .run();
        for (po::option given : parsed.options) {
            given.value = shownStreams(given.value);
            if (given.string_key == "inputs") {
                arguments.inputs.insert(arguments.inputs.end(), given.value.begin(), given.value.end());
                continue;
            }
            auto& values = arguments.values[given.string_key];
            if (given.value.empty())
                values = {"true"};
            else
                values.insert(values.end(), given.value.begin(), given.value.end());
        }
    } catch (const po::unknown_option& e) {
        const std::string name = dashed(e.get_option_name());
        const std::string near = nearestName(name, names);
        refuse("--" + name + ": unknown option" +
               (near.empty() ? "; see --help" : "; did you mean --" + near + "?"));
    } catch (const po::error_with_option_name& e) {
        refuse("--" + dashed(e.get_option_name()) + ": needs a value; see --help");
    } catch (const po::error& e) {
        refuse(std::string(e.what()) + "; see --help");
    }
    for (const Option& option : options)
        if (!option.repeats && arguments.all(option.name).size() > 1)
            refuse("--" + option.name + ": given twice");
    return arguments;
}

std::vector<std::string> splitAtCommas(const std::string& text) {
    std::vector<std::string> parts;
    std::size_t begin = 0;
    for (std::size_t comma; (comma = text.find(',', begin)) != std::string::npos; begin = comma + 1)
        parts.push_back(text.substr(begin, comma - begin));
    parts.push_back(text.substr(begin));
    return parts;
}

}  // namespace vdbsynth::cli
