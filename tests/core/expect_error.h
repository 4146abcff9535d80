#pragma once

#include <gtest/gtest.h>

#include <string>

namespace symsurf {

/// Expects the call to throw an Error whose message holds the text.
template <typename Error, typename Call>
void expect_error(const std::string& text, const Call& call) {
  try {
    call();
    ADD_FAILURE() << "no error, where one should say: " << text;
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find(text), std::string::npos)
        << "'" << error.what() << "' does not say: " << text;
  }
}

}  // namespace symsurf
