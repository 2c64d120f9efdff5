#pragma once
#include "tools/vdb_synth/option.h"

#include <string>
#include <utility>
#include <vector>

namespace vdbsynth::cli {

// Constructors of table entries; Option's setters complete them.

inline Option option(Kind kind, const std::string& name, const std::string& argument) {
    Option made;
    made.name = name;
    made.argument = argument;
    made.kind = kind;
    made.fields = {camelCase(name)};
    made.incidental = kind == Kind::Output || kind == Kind::Folder;
    return made;
}

inline Option flag(const std::string& name) {
    return option(Kind::Flag, name, "");
}
inline Option whole(const std::string& name, const std::string& argument, double low, double high) {
    return option(Kind::Whole, name, argument).from(low, high);
}
/// An odd number.
inline Option odd(const std::string& name, const std::string& argument, double low, double high) {
    Option made = whole(name, argument, low, high);
    made.odd = true;
    return made;
}
inline Option real(const std::string& name, const std::string& argument, double low = -kUnbounded,
                   double high = kUnbounded) {
    return option(Kind::Real, name, argument).from(low, high);
}
/// A length above 0 in world units.
inline Option worldLength(const std::string& name, const std::string& argument) {
    return real(name, argument, kAboveZero).measuredIn(Unit::World);
}
inline Option choice(const std::string& name, const std::string& argument, std::vector<Choice> choices) {
    Option made = option(Kind::Choice, name, argument);
    made.choices = std::move(choices);
    return made;
}
inline Option axisChoices(const std::string& name, const std::string& argument, std::vector<Choice> choices) {
    Option made = option(Kind::AxisChoices, name, argument);
    made.choices = std::move(choices);
    return made;
}
inline Option file(const std::string& name, const std::string& argument,
                   std::vector<std::string> extensions) {
    Option made = option(Kind::File, name, argument);
    made.extensions = std::move(extensions);
    return made;
}
inline Option grid(const std::string& name) {
    return option(Kind::Grid, name, "FILE.vdb[:GRID]");
}
inline Option output(const std::string& name, const std::string& argument,
                     std::vector<std::string> extensions) {
    Option made = option(Kind::Output, name, argument).in(Group::Output);
    made.extensions = std::move(extensions);
    return made;
}

}  // namespace vdbsynth::cli
