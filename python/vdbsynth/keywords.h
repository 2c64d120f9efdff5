#pragma once
#include "python/vdbsynth/values.h"

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace vdbsynth::python {

/// A keyword of a function: a field of an options struct under the field's own name.
struct Keyword {
    std::string name;
    std::string type;                                   ///< as in the stubs
    std::string initial;                                ///< the field's default, as Python writes it
    std::string about;                                  ///< unit, range, what it is for
    std::vector<std::function<void(py::handle)>> take;  ///< writes the fields of this name
};

/// The keywords of one call, bound to the fields of its options.
class Keywords {
public:
    /// @param function  begins messages
    explicit Keywords(std::string function) : mFunction(std::move(function)) {}

    /// Two structs of a function may have fields of one name: both are written, the first one's text counts.
    template <typename Field>
    void add(const std::string& name, Field& field, const std::string& about) {
        add({name, Value<Field>::type(), Value<Field>::text(field), about, {[name, &field](py::handle value) {
                 field = Value<Field>::from(name, value);
             }}});
    }
    void add(Keyword keyword);

    /// Writes what is given into the fields.
    /// @throw TypeError (a keyword that the function has not: it names the nearest one, or all; a value of
    /// another type), Error InvalidOption (a word that is not one of the field's)
    void read(const py::dict& given) const;
    const std::vector<Keyword>& all() const { return mAll; }

private:
    std::string mFunction;
    std::vector<Keyword> mAll;
};

/// A struct that is given as a dict of its own fields, by the same rules.
template <typename Options>
struct DictValue {
    static std::string type() { return "Mapping[str, object]"; }
    static std::string text(const Options&) { return "{}"; }
    static Options from(const std::string& name, py::handle value) {
        if (!py::isinstance<py::dict>(value)) refuse(name, "a dict", value);
        Options options;
        Keywords keywords(name);
        describe(keywords, options);
        keywords.read(py::reinterpret_borrow<py::dict>(value));
        return options;
    }
};

/// The keyword nearest to a mistyped one; empty if none is near. Underscores, dashes and capitals do not
/// count, so that the command line's names (half-width) find the field's (halfWidth).
std::string nearestKeyword(const std::string& given, const std::vector<Keyword>& keywords);

}  // namespace vdbsynth::python
