// SPDX-License-Identifier: MIT
#include "ThrowBodyKeys.h"

#include "ThrowTiming.h"

namespace mannequin {
// The pelvis opens first and the thorax follows, which stretches the trunk: they differ by about
// 50 degrees at the contact, in line with the peaks of Fleisig et al. (1999). At the release the
// trunk tilts 33 degrees to the target (ibid.) and 23 to the glove side (Escamilla et al. 1998).
// The thorax is arched back relative to the pelvis up to the maximum external rotation.
BodyKeys bodyKeys() {
    constexpr double kBody = 0.06;
    constexpr double kTrunk = 0.03;
    BodyKeys k;
    // Back over the pivot foot, forward into the lead leg, and two steps back to the set.
    k.x = {kBody,
           {{0, 0},
            {0.2, -.05},
            {0.43, -.12},
            {0.58, -.08},
            {0.72, .12},
            {kContact, .47},
            {kRelease, .61},
            {1.25, .73},
            {1.45, .82},
            {1.65, .85},
            {1.9, .74},
            {2.2, .44},
            {2.5, .12},
            {2.78, 0}}};
    k.y = {kBody,
           {{0, 0.945},
            {kKneeUp, 0.952},
            {0.62, 0.93},
            {0.75, 0.87},
            {0.87, 0.79},
            {0.95, 0.78},
            {kRelease, 0.833},
            {1.3, 0.842},
            {1.5, 0.838},
            {1.7, 0.875},
            {1.95, 0.9},
            {2.22, 0.8},
            {2.48, 0.9},
            {2.66, 0.938},
            {2.8, 0.945}}};
    k.z = {kBody,
           {{0, 0},
            {kContact, 0.02},
            {kRelease, 0.03},
            {1.4, 0.04},
            {1.65, 0.09},
            {2.2, 0.04},
            {2.6, 0}}};
    // Less than 90 degrees, where the root's BVH angles Z Y X have a gimbal lock.
    k.pelvisYaw = {kTrunk,
                   {{0, 0},
                    {0.15, -1},
                    {0.475, -22},
                    {0.64, -17},
                    {0.8, 5},
                    {kContact, 34},
                    {0.965, 66},
                    {1.03, 78},
                    {kRelease, 80},
                    {1.3, 80},
                    {1.65, 76},
                    {1.9, 60},
                    {2.3, 22},
                    {2.65, 0}}};
    k.pelvisLeanX = {kTrunk,
                     {{0, 0},
                      {kKneeUp, -5},
                      {0.75, -4},
                      {kContact, 4},
                      {kMaxExternal, 14},
                      {kRelease, 20},
                      {1.3, 38},
                      {1.45, 36},
                      {1.65, 22},
                      {1.9, 8},
                      {2.2, 2},
                      {2.6, 0}}};
    k.pelvisLeanZ = {kTrunk,
                     {{0, 3},
                      {kKneeUp, -6},
                      {0.75, 6},
                      {kContact, 5},
                      {kRelease, -7},
                      {1.3, -4},
                      {1.6, 0},
                      {2.2, 5},
                      {2.7, 3}}};
    k.thoraxYaw = {kTrunk,
                   {{0, 0},
                    {0.2, -4},
                    {0.5, -28},
                    {0.65, -30},
                    {0.8, -27},
                    {kContact, -13},
                    {0.955, 18},
                    {kMaxExternal, 56},
                    {1.05, 77},
                    {kRelease, 89},
                    {1.16, 106},
                    {1.35, 118},
                    {1.6, 106},
                    {1.9, 76},
                    {2.3, 26},
                    {2.65, 0}}};
    k.thoraxLeanX = {kTrunk,
                     {{0, 0},
                      {0.5, -4},
                      {0.75, -9},
                      {kContact, -6},
                      {kMaxExternal, 9},
                      {kRelease, 38},
                      {1.2, 62},
                      {1.35, 70},
                      {1.5, 60},
                      {1.75, 30},
                      {2.0, 12},
                      {2.4, 3},
                      {2.65, -2},
                      {2.85, 0}}};
    k.thoraxLeanZ = {kTrunk,
                     {{0, 3},
                      {kKneeUp, 8},
                      {0.65, 10},
                      {kContact, 2},
                      {kMaxExternal, 1},
                      {kRelease, -26},
                      {1.13, -38},
                      {1.3, -16},
                      {1.6, 0},
                      {2.2, 5},
                      {2.7, 3}}};
    // The eyes stay on the target from the set to the step back.
    k.headYaw = {kTrunk,
                 {{0, 62},
                  {0.42, 40},
                  {0.65, 42},
                  {0.8, 52},
                  {kContact, 66},
                  {kMaxExternal, 82},
                  {kRelease, 90},
                  {1.3, 92},
                  {1.7, 90},
                  {2.1, 80},
                  {2.5, 64}}};
    k.headNod = {
        kTrunk,
        {{0, 4}, {kKneeUp, 6}, {kContact, 2}, {kRelease, 20}, {1.3, 28}, {1.7, 8}, {2.2, 4}}};
    k.headRoll = {kTrunk, {{0, 0}, {kContact, 0}, {kRelease, -10}, {1.3, -6}, {1.7, 0}}};
    return k;
}

} // namespace mannequin
