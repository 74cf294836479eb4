#include "parallel/observation/process_memory.hpp"

#include <cstdio>
#include <cstring>

namespace aeroloom::parallel {

std::int64_t process_memory(const char* path, const char* key) {
  std::FILE* status = std::fopen(path, "r");
  if (!status) return 0;
  char line[256];
  long long kibibytes = 0;
  const std::size_t length = std::strlen(key);
  while (std::fgets(line, sizeof line, status)) {
    if (std::strncmp(line, key, length) == 0 && std::sscanf(line + length, ": %lld", &kibibytes) == 1) break;
  }
  std::fclose(status);
  return 1024 * static_cast<std::int64_t>(kibibytes);
}

}  // namespace aeroloom::parallel
