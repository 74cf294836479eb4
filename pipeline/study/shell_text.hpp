/// Texts for the shell and for a batch system. Whatever comes from a user or a file gets into a line or a
/// script through these functions, and stands there as data.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace aeroloom::study {

/// Quotes a word for the shell.
std::string quoted(const std::string& word);
/// Quotes and joins the words of a command.
std::string quoted(const std::vector<std::string>& words);

/// A line for each variable of a script that sets it, whatever its value holds.
std::string assignments(const std::vector<std::pair<std::string, std::string>>& variables);

/// Puts a command into each place of `mark` in the user's line, quoted as quotes around the place ask for.
/// Leaves out comments. Throws std::invalid_argument for places that have no such quoting: within backticks
/// or two kinds of quotes, and lines with here-documents.
std::string with_command(const std::string& line, const std::string& mark,
                         const std::vector<std::string>& command);

/// Quotes the path of a file for a line `#SBATCH`, in which the batch system replaces nothing. Throws
/// std::invalid_argument for line breaks, which end such a line.
std::string quoted_for_queue(const std::string& path);

/// Quotes the value of `--set KEY=VALUE`, which is YAML. Throws std::invalid_argument for a path that no key
/// has: with '${', which names an environment variable, or not in UTF-8.
std::string quoted_for_key(const std::string& path);

}  // namespace aeroloom::study
