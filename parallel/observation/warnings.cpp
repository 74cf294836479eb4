#include "parallel/observation/warnings.hpp"

#include <algorithm>
#include <unordered_map>

namespace aeroloom::parallel {
namespace {

// Warnings are kept as far as a report can be read with them, and as rank 0 can hold those of thousands of
// ranks. Texts of a rank; of all ranks, in those of one; bytes of one text, of a rank, of all others
// together, and of one of very many.
constexpr std::size_t most_texts = 100, texts_of_all = 5;
constexpr std::size_t longest_text = 4000;
constexpr std::size_t most_bytes = 64 << 10;
constexpr std::size_t most_bytes_of_others = 4 << 20;
constexpr std::size_t least_bytes_of_a_rank = 1 << 10;

/// Cut where no letter of UTF-8 is cut in two.
std::string shortened(const std::string& text) {
  if (text.size() <= longest_text) return text;
  std::size_t end = longest_text;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;
  std::string beginning = text.substr(0, end);
  beginning += " ...";
  return beginning;
}

/// Texts in the order in which they came, each once, up to `room` bytes.
class Collection {
public:
  explicit Collection(std::size_t texts, std::size_t room) : _texts(texts), _room(room) {}
  void add(const Warning& warning) {
    const auto known = _place.find(warning.message);
    if (known != _place.end()) {
      _warnings.kept[known->second].times += warning.times;
      return;
    }
    if (_warnings.kept.size() == _texts || warning.message.size() > _room) {
      _warnings.left_out += warning.times;
      return;
    }
    _room -= warning.message.size();
    _place.emplace(warning.message, _warnings.kept.size());
    _warnings.kept.push_back(warning);
  }
  void leave_out(std::int64_t times) { _warnings.left_out += times; }
  const Warnings& warnings() const { return _warnings; }

private:
  std::size_t _texts, _room;
  Warnings _warnings;
  std::unordered_map<std::string, std::size_t> _place;
};

Collection& of_this_rank() {
  static Collection instance(most_texts, most_bytes);
  return instance;
}

Warnings fitting(const Warnings& warnings, std::size_t room) {
  Collection some(most_texts, room);
  for (const Warning& warning : warnings.kept) some.add(warning);
  some.leave_out(warnings.left_out);
  return some.warnings();
}

}  // namespace

void keep_warning(const std::string& message) {
  of_this_rank().add({shortened(message)});
}

Warnings take_warnings(const Communicator& communicator) {
  const auto others = static_cast<std::size_t>(std::max(1, communicator.size() - 1));
  const std::size_t room = communicator.is_root()
                               ? most_bytes
                               : std::clamp(most_bytes_of_others / others, least_bytes_of_a_rank, most_bytes);
  std::vector<Warnings> parts = communicator.gather_values(fitting(of_this_rank().warnings(), room));
  of_this_rank() = Collection(most_texts, most_bytes);
  Collection all(texts_of_all * most_texts, most_bytes + most_bytes_of_others);
  for (std::size_t r = 0; r < parts.size(); ++r) {
    for (Warning& warning : parts[r].kept) {
      warning.rank = static_cast<Rank>(r);
      all.add(warning);
    }
    all.leave_out(parts[r].left_out);
  }
  return all.warnings();
}

}  // namespace aeroloom::parallel
