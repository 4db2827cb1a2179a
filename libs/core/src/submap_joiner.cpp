#include <submap_slam/core/submap_joiner.h>

IMPLEMENTS_VIRTUAL_MRPT_OBJECT(SubmapJoiner, mrpt::rtti::CObject, submap_slam)
