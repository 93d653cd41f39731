// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_ELASTIC_EACHATONCE_H
#define OSGSKINBIND_ELASTIC_EACHATONCE_H

#include <cstddef>

#ifdef OSGSKIN_HAS_TBB
#include <tbb/parallel_for.h>
#endif

namespace osgSkin::elastic {

/// Calls work(0) ... work(count - 1): on all processors where oneTBB is built in, else in turn. An
/// exception passes through. May be nested.
template <typename Work>
void eachAtOnce(std::size_t count, const Work& work) {
#ifdef OSGSKIN_HAS_TBB
    tbb::parallel_for(std::size_t(0), count, work);
#else
    for (std::size_t i = 0; i < count; ++i) work(i);
#endif
}

} // namespace osgSkin::elastic

#endif
