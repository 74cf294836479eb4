#include "io/medit/local_medit_mesh.hpp"
#include "io/streams/range_reader.hpp"
#include "parallel/communication/collective_error.hpp"

#include <algorithm>
#include <cstddef>

#include <fmt/format.h>

namespace aeroloom::io {

namespace {

using mesh::GlobalIndex;

constexpr std::int64_t chunk_bytes = std::int64_t{1} << 20;

/// How a file writes its numbers.
struct Widths {
  std::int32_t version = 3;
  ByteOrder order = ByteOrder::little;
  int real() const { return version == 1 ? 4 : 8; }
  int integer() const { return version < 4 ? 4 : 8; }
  int position() const { return version < 3 ? 4 : 8; }
};

/// A section that is read.
struct Section {
  std::int32_t keyword = 0;
  std::int64_t lines = 0, count = 0;
};

std::int64_t decode_integer(const RangeReader& file, const std::byte* at, int width) {
  return width == 4 ? std::int64_t{file.decoded<std::int32_t>(at)} : file.decoded<std::int64_t>(at);
}

double decode_real(const RangeReader& file, const std::byte* at, int width) {
  return width == 4 ? double{file.decoded<float>(at)} : file.decoded<double>(at);
}

/// The chain of sections of a file.
class SectionChain {
public:
  explicit SectionChain(RangeReader& file) : _file(file) {}

  Widths widths;
  std::vector<Section> sections;

  void follow() {
    std::int64_t at = read_start();
    while (at != 0) at = read_section(at);
  }

private:
  std::int64_t integer(std::int64_t at, int width) {
    return width == 4 ? std::int64_t{_file.value<std::int32_t>(at)} : _file.value<std::int64_t>(at);
  }

  /// Magic, version and dimension; returns where the next section begins.
  std::int64_t read_start() {
    _file.set_order(widths.order);
    const std::int64_t magic = integer(0, 4);
    if (magic != 1 && magic != 16777216) _file.fail(0, "this is no Medit file: it does not begin with 1");
    if (magic != 1) widths.order = ByteOrder::big;
    _file.set_order(widths.order);
    const std::int64_t version = integer(4, 4);
    if (version < 1 || version > 4) _file.fail(4, fmt::format("there is no version {}", version));
    widths.version = static_cast<std::int32_t>(version);
    if (integer(8, 4) != static_cast<std::int32_t>(MeditKeyword::dimension))
      _file.fail(8, "the file does not begin with its dimension");
    const std::int64_t next = position(12), value_at = 12 + widths.position();
    const std::int64_t dimension = integer(value_at, 4);
    if (dimension != 3) _file.fail(value_at, fmt::format("the mesh has {} dimensions, not 3", dimension));
    return right_after(8, value_at + 4, next);
  }

  std::int64_t position(std::int64_t at) { return integer(at, widths.position()); }

  /// `next` where it is a place after `end`; a section at `begin` may not lead back, nor into itself.
  std::int64_t after(std::int64_t begin, std::int64_t end, std::int64_t next) const {
    if (next == 0) {
      require_end(end);
      return 0;
    }
    if (next < end || next > _file.size() - 4) {
      _file.fail(begin, fmt::format("the section that begins here is followed by one at byte {}, but it ends "
                                    "at byte {} and the file at byte {}",
                                    next, end, _file.size()));
    }
    return next;
  }

  /// As after() for a section whose length is known: the next one begins where it ends.
  std::int64_t right_after(std::int64_t begin, std::int64_t end, std::int64_t next) const {
    if (next > end && next <= _file.size() - 4) {
      _file.fail(begin, fmt::format("the section that begins here ends at byte {} by its count, but the next "
                                    "one begins at byte {}; the file is damaged",
                                    end, next));
    }
    return after(begin, end, next);
  }

  /// Whether the file has no more than a section needs that ends here.
  void require_end(std::int64_t end) const {
    if (_file.bytes_from(end) > 0) {
      _file.fail(end, fmt::format("the last section ends here, but {} bytes follow; the file is damaged",
                                  _file.bytes_from(end)));
    }
  }

  std::int64_t line_bytes(std::int64_t keyword) const {
    if (keyword == static_cast<std::int32_t>(MeditKeyword::vertices))
      return 3 * widths.real() + widths.integer();
    const int corners = medit_corners(static_cast<std::int32_t>(keyword));
    return corners == 0 ? 0 : std::int64_t{corners + 1} * widths.integer();
  }

  /// Returns where the next one begins, 0: nowhere.
  std::int64_t read_section(std::int64_t at) {
    const std::int64_t keyword = integer(at, 4);
    if (keyword == static_cast<std::int32_t>(MeditKeyword::end)) {
      // Some programs leave out the position of what does not follow.
      if (_file.bytes_from(at + 4) > 0) require_end(at + 4 + widths.position());
      return 0;
    }
    if (keyword <= 0) _file.fail(at, fmt::format("there is no keyword {}", keyword));
    const std::int64_t next = position(at + 4), count_at = at + 4 + widths.position();
    const std::string unreadable = medit_unreadable(static_cast<std::int32_t>(keyword));
    const std::int64_t bytes = line_bytes(keyword);
    if (bytes == 0 && unreadable.empty()) return after(at, count_at, next);
    const std::int64_t count = integer(count_at, widths.integer()), lines = count_at + widths.integer();
    if (!unreadable.empty()) {
      if (count == 0) return after(at, lines, next);
      _file.fail(at, fmt::format("there are {} {}; only tetrahedra, pyramids, prisms and hexahedra with "
                                 "straight edges can be read",
                                 count, unreadable));
    }
    if (count < 0 || count > (_file.size() - lines) / bytes) {
      _file.fail(count_at, fmt::format("{} {} do not fit into the file, which ends at byte {}", count,
                                       name_of(static_cast<MeditKeyword>(keyword)), _file.size()));
    }
    for (const Section& other : sections) {
      if (other.keyword == keyword)
        _file.fail(at, fmt::format("{} come twice", name_of(static_cast<MeditKeyword>(keyword))));
    }
    sections.push_back({static_cast<std::int32_t>(keyword), lines, count});
    return right_after(at, lines + count * bytes, next);
  }

  RangeReader& _file;
};

/// Reads the items of this rank.
class LocalMeditReader {
public:
  LocalMeditReader(const SharedPath& file, Widths widths) : _shared(file), _file(file.path), _widths(widths) {
    _file.set_order(widths.order);
  }

  LocalMeditMesh local;

  void read(const Section& section) {
    if (section.keyword == static_cast<std::int32_t>(MeditKeyword::vertices)) {
      read_vertices(section);
    } else {
      read_items(section, *local.items(section.keyword), medit_corners(section.keyword));
    }
  }

private:
  /// Calls `visit(line)` for the lines of this rank.
  template <class Visit>
  void for_each_line(const Section& section, std::int64_t line_bytes, const Visit& visit) {
    const auto [begin, end] = _shared.local_range(section.count);
    const std::int64_t in_chunk = std::max<std::int64_t>(1, chunk_bytes / line_bytes);
    for (std::int64_t first = begin; first < end; first += in_chunk) {
      const std::int64_t lines = std::min(in_chunk, end - first);
      _buffer.resize(static_cast<std::size_t>(lines * line_bytes));
      _file.read_bytes(section.lines + first * line_bytes, _buffer);
      for (std::int64_t i = 0; i < lines; ++i) visit(_buffer.data() + i * line_bytes);
    }
  }

  void read_vertices(const Section& section) {
    const LocalRange range = _shared.local_range(section.count);
    local.first_point = range.begin;
    local.coordinates.reserve(3 * static_cast<std::size_t>(range.count()));
    const int width = _widths.real();
    for_each_line(section, 3 * width + _widths.integer(), [&](const std::byte* line) {
      for (int axis = 0; axis < 3; ++axis)
        local.coordinates.push_back(decode_real(_file, line + axis * width, width));
    });
  }

  void read_items(const Section& section, MeditItems& items, int corners) {
    const LocalRange range = _shared.local_range(section.count);
    items.corners.reserve(static_cast<std::size_t>(corners * range.count()));
    items.references.reserve(static_cast<std::size_t>(range.count()));
    const int width = _widths.integer();
    std::int64_t at = section.lines + range.begin * (corners + 1) * width;
    for_each_line(section, std::int64_t{corners + 1} * width, [&](const std::byte* line) {
      for (int k = 0; k < corners; ++k) {
        const std::int64_t corner = decode_integer(_file, line + k * width, width);
        if (corner < 1) _file.fail(at + k * width, fmt::format("there is no vertex {}", corner));
        items.corners.push_back(corner - 1);
      }
      items.references.push_back(decode_integer(_file, line + corners * width, width));
      at += std::int64_t{corners + 1} * width;
    });
  }

  const SharedPath& _shared;
  RangeReader _file;
  Widths _widths;
  std::vector<std::byte> _buffer;
};

}  // namespace

LocalMeditMesh read_medit_binary(const SharedPath& file) {
  const parallel::Communicator& communicator = file.communicator;
  std::vector<Widths> widths;
  std::vector<Section> sections;
  parallel::on_root(communicator, [&] {
    RangeReader reader(file.path);
    SectionChain chain(reader);
    chain.follow();
    widths = {chain.widths};
    sections = std::move(chain.sections);
  });
  communicator.broadcast_items(widths);
  communicator.broadcast_items(sections);
  LocalMeditMesh local;
  parallel::agree(communicator, [&] {
    LocalMeditReader reader(file, widths.front());
    for (const Section& section : sections) reader.read(section);
    local = std::move(reader.local);
  });
  return local;
}

}  // namespace aeroloom::io
