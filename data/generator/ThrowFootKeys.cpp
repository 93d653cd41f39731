// SPDX-License-Identifier: MIT
#include "ThrowFootKeys.h"

#include "ThrowTiming.h"

namespace mannequin {
namespace {

constexpr double kFoot = 0.03;

} // namespace

// Planted up to the contact, dragged on its toes up to the release, swung forward to land beside
// the lead foot, then stepped back to the set position.
FootKeys pivotFootKeys() {
    FootKeys k;
    k.x = {kFoot,
           {{0, -0.19},
            {kContact, -0.19},
            {0.99, -0.09},
            {kRelease, 0.04},
            {1.2, 0.2},
            {1.4, 0.55},
            {1.6, 0.84},
            {1.86, 0.84},
            {2.22, -0.19}}};
    k.z = {kFoot,
           {{0, 0.125},
            {kContact, 0.125},
            {kRelease, 0.14},
            {1.25, 0.3},
            {1.4, 0.38},
            {1.6, 0.36},
            {1.86, 0.36},
            {2.05, 0.28},
            {2.22, 0.125}}};
    k.lift = {kFoot,
              {{0, 0},
               {1.1, 0},
               {1.28, 0.33},
               {1.42, 0.26},
               {1.62, 0},
               {1.86, 0},
               {2.03, 0.1},
               {2.22, 0}}};
    k.yaw = {kFoot,
             {{0, 0},
              {0.64, 0},
              {kContact, 46},
              {kRelease, 78},
              {1.3, 84},
              {1.6, 78},
              {1.86, 78},
              {2.22, 0}}};
    k.heel = {kFoot,
              {{0, 0},
               {0.66, 0},
               {0.82, 30},
               {kContact, 56},
               {kRelease, 76},
               {1.28, 84},
               {1.45, 30},
               {1.56, -4},
               {1.66, 0},
               {1.76, 0},
               {1.9, 30},
               {2.06, 16},
               {2.2, 14},
               {2.36, 0}}};
    k.kneeOut = {kFoot, {{0, 0}, {0.7, 0}, {kContact, 10}, {1.4, 0}}};
    return k;
}

// Lifted, set down on its heel about 65 % of the stature ahead of the pivot foot (a pitcher strides
// 85 %, Fleisig et al. 1999; this is a throw on level ground), then stepped back after the pivot
// foot.
FootKeys leadFootKeys() {
    FootKeys k;
    k.x = {kFoot,
           {{0, .19},
            {0.10, .19},
            {0.475, -.02},
            {0.56, .06},
            {0.68, .42},
            {0.885, 1.12},
            {2.24, 1.12},
            {2.64, .19}}};
    k.z = {kFoot,
           {{0, 0.125},
            {0.1, 0.125},
            {kKneeUp, 0.24},
            {0.6, 0.23},
            {0.885, 0.08},
            {2.24, 0.08},
            {2.64, 0.125}}};
    k.lift = {kFoot,
              {{0, 0},
               {0.1, 0},
               {kKneeUp, 0.46},
               {0.6, 0.31},
               {0.74, 0.12},
               {0.85, 0.012},
               {0.885, 0},
               {2.24, 0},
               {2.44, 0.1},
               {2.64, 0}}};
    k.yaw = {kFoot,
             {{0, 0}, {0.12, 0}, {kKneeUp, -20}, {0.65, 5}, {0.87, 66}, {2.24, 66}, {2.62, 0}}};
    k.heel = {kFoot,
              {{0, 0},
               {0.06, 0},
               {0.2, 18},
               {kKneeUp, 30},
               {0.65, 10},
               {0.8, -14},
               {kContact, 0},
               {2.12, 0},
               {2.28, 32},
               {2.44, 16},
               {2.6, 12},
               {2.76, 0}}};
    k.kneeOut = {kFoot, {{0, 0}}};
    return k;
}

} // namespace mannequin
