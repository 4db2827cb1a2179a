#pragma once

namespace submap_slam {

/** Gives back the pages of libraries that are only read and hold no code, nearly all of them tables of
 * symbols and relocations that the dynamic linker went through: MRPT's image library brings 150 libraries
 * along, most of which a run never calls. What is needed nevertheless comes back from the system's cache of
 * files. To be called when all plugins are loaded. */
void giveBackSymbolTables();

}  // namespace submap_slam
