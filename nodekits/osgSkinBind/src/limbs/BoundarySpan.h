// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_BOUNDARYSPAN_H
#define OSGSKINBIND_BOUNDARYSPAN_H

namespace osgSkin {

/// The upper and lower boundary of a bend or twist region (paper, Fig. 3): along a bone from the
/// joint's centre, in units of that bone's length, negative towards the parent.
struct BoundarySpan {
    double upper;
    double lower;
};

} // namespace osgSkin

#endif
