#include "symbol_tables.h"

#include <link.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>

namespace submap_slam {
namespace {

int giveBackReadOnlyData(dl_phdr_info* library, std::size_t, void*) {
  const auto page = static_cast<uintptr_t>(sysconf(_SC_PAGESIZE));
  for (std::size_t k = 0; k < library->dlpi_phnum; ++k) {
    const auto& segment = library->dlpi_phdr[k];
    // Relocations are written to segments that count as writable, whatever they are protected to later.
    if (segment.p_type != PT_LOAD || (segment.p_flags & (PF_W | PF_X)) != 0) continue;
    const uintptr_t begin = library->dlpi_addr + segment.p_vaddr, end = begin + segment.p_memsz;
    const uintptr_t first = begin / page * page, last = end / page * page;
    if (first < last) madvise(reinterpret_cast<void*>(first), last - first, MADV_DONTNEED);
  }
  return 0;
}

}  // namespace

void giveBackSymbolTables() { dl_iterate_phdr(giveBackReadOnlyData, nullptr); }

}  // namespace submap_slam
