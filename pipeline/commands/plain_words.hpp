/// Rewrites messages of the standard library for users.
#pragma once

#include <string>

namespace aeroloom::pipeline {

/// Replaces "filesystem error: cannot read: No such file or directory [a/b]" by "cannot read 'a/b': No such
/// file or directory", and removes ": iostream error", which gives no reason. All other text stays.
std::string plain_words(const std::string& message);

}  // namespace aeroloom::pipeline
