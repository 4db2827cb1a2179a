#include "symbol_tables.h"

#include <link.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>

namespace submap_slam {
namespace {

/** Whether the dynamic linker also wrote to segments that count as read-only. */
bool hasTextRelocations(const dl_phdr_info& library) {
  for (std::size_t k = 0; k < library.dlpi_phnum; ++k) {
    if (library.dlpi_phdr[k].p_type != PT_DYNAMIC) continue;
    const auto* entry = reinterpret_cast<const ElfW(Dyn)*>(library.dlpi_addr + library.dlpi_phdr[k].p_vaddr);
    for (; entry->d_tag != DT_NULL; ++entry)
      if (entry->d_tag == DT_TEXTREL || (entry->d_tag == DT_FLAGS && (entry->d_un.d_val & DF_TEXTREL) != 0))
        return true;
  }
  return false;
}

int giveBackReadOnlyData(dl_phdr_info* library, std::size_t, void*) {
  if (hasTextRelocations(*library)) return 0;
  const auto page = static_cast<uintptr_t>(sysconf(_SC_PAGESIZE));
  for (std::size_t k = 0; k < library->dlpi_phnum; ++k) {
    const auto& segment = library->dlpi_phdr[k];
    // All other relocations are in segments that count as writable, whatever they are protected to later.
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
