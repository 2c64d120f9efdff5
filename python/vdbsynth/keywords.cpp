#include "python/vdbsynth/keywords.h"

#include <algorithm>
#include <cctype>
#include <numeric>

namespace vdbsynth::python {
namespace {

std::string plain(const std::string& name) {
    std::string letters;
    for (const char c : name)
        if (c != '_' && c != '-') letters += char(std::tolower(static_cast<unsigned char>(c)));
    return letters;
}

// Letters to insert, delete or change.
std::size_t editDistance(const std::string& a, const std::string& b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t(0));
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t change = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
            diagonal = row[j];
            row[j] = std::min({row[j] + 1, row[j - 1] + 1, change});
        }
    }
    return row.back();
}

std::string namesOf(const std::vector<Keyword>& keywords) {
    std::string names;
    for (const Keyword& keyword : keywords) names += (names.empty() ? "" : ", ") + keyword.name;
    return names;
}

}  // namespace

void Keywords::add(Keyword keyword) {
    for (Keyword& known : mAll)
        if (known.name == keyword.name) {
            known.take.insert(known.take.end(), keyword.take.begin(), keyword.take.end());
            return;
        }
    mAll.push_back(std::move(keyword));
}

void Keywords::read(const py::dict& given) const {
    for (const auto& [key, value] : given) {
        if (!py::isinstance<py::str>(key)) refuse(mFunction, "a dict of str", key);
        const std::string name = py::cast<std::string>(key);
        const auto found = std::find_if(mAll.begin(), mAll.end(),
                                        [&](const Keyword& keyword) { return keyword.name == name; });
        if (found == mAll.end()) {
            const std::string nearest = nearestKeyword(name, mAll);
            throw py::type_error(
                mFunction + ": unknown keyword " + name +
                (nearest.empty() ? "; it takes " + namesOf(mAll) : "; did you mean " + nearest + "?"));
        }
        for (const auto& take : found->take) take(value);
    }
}

std::string nearestKeyword(const std::string& given, const std::vector<Keyword>& keywords) {
    const std::string wanted = plain(given);
    std::string nearest;
    std::size_t least = std::max<std::size_t>(1, wanted.size() / 3) + 1;
    for (const Keyword& keyword : keywords) {
        const std::size_t distance = editDistance(wanted, plain(keyword.name));
        if (distance < least) {
            least = distance;
            nearest = keyword.name;
        }
    }
    return nearest;
}

}  // namespace vdbsynth::python
