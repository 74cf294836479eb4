/// Messages as users read them.
#pragma once

#include <string>

namespace aeroloom::pipeline {

/// "cannot read 'a/b': No such file or directory" for what the standard library says of a file: "filesystem
/// error: cannot read: No such file or directory [a/b]"; without ": iostream error", which gives no reason.
/// What stands before and after stays, and so does every other text.
std::string plain_words(const std::string& message);

}  // namespace aeroloom::pipeline
