#pragma once

#include <functional>
#include <string>

namespace submap_slam {

/** Puts a new file in the place of `file` in one step: whoever looks, and a kill at any time, finds the old
 * one or the new one, never half of it. Throws what `write` throws, which leaves the old one, and OutputError
 * if the new one cannot be moved there.
 * @param write writes the new file under the name it is given, FILE.part; whatever has that name is
 * overwritten */
void replaceFile(const std::string& file, const std::function<void(const std::string&)>& write);

}  // namespace submap_slam
