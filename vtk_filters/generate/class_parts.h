#pragma once

#include "described.h"

// What classes that are made at build time have in common: one member, one Set and one Get a
// parameter, as VTK programmers write them.

namespace symsurf::front_ends {

/// The first line of whatever is made.
std::string notice();

/// A documentation comment and the Set and Get of a text.
std::string text_accessors(const std::string& name, const std::string& doc);
std::string text_member(const std::string& name, const std::string& value);

/// The same of every parameter.
std::string accessors(const Described& described);
std::string members(const Described& described);

/// Lines of PrintSelf.
std::string printed_text(const std::string& name);
std::string printed(const Described& described);

/// The choice's parameters as the core takes them, a line each, read from a pointer to the filter.
std::string values_of(const Choice& choice, const std::string& filter);

/// '"text"'.
std::string quoted(const std::string& text);

}  // namespace symsurf::front_ends
