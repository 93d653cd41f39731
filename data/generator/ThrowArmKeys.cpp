// SPDX-License-Identifier: MIT
#include "ThrowArmKeys.h"

#include "ThrowTiming.h"

namespace mannequin {
// At the contact: abduction 93 degrees, external rotation 67, horizontal adduction -17, elbow
// flexion 98 (Dillman et al. 1993; Fleisig et al. 1999: 74 to 100). Greatest external rotation 173
// to 178 (ibid.). At the release: abduction 91 to 96, elbow flexion 23 (Fleisig et al. 1999). The
// keys in between were posed by eye, and tuned until the ball is released level and at its fastest.
ArmKeys throwingArmKeys() {
    constexpr double kSlow = 0.04;
    constexpr double kFast = 0.016;
    ArmKeys k;
    k.protraction = {kSlow,
                     {{0, 10},
                      {kKneeUp, 10},
                      {0.75, -8},
                      {kContact, -16},
                      {0.97, -16},
                      {kRelease, 1},
                      {1.2, 22},
                      {1.45, 26},
                      {1.8, 12},
                      {2.4, 10}}};
    k.elevation = {kSlow,
                   {{0, 2},
                    {0.35, 0},
                    {0.65, -2},
                    {kContact, 10},
                    {kMaxExternal, 13},
                    {kRelease, 10},
                    {1.3, -4},
                    {1.7, 0},
                    {2.5, 0}}};
    // The girdle's share of the external rotation; the upper arm's joint has the rest.
    k.tilt = {kSlow,
              {{0, 0},
               {0.8, 0},
               {kContact, 6},
               {kMaxExternal, 20},
               {kRelease, 8},
               {1.2, -10},
               {1.5, -6},
               {1.8, 0}}};
    k.abduction = {kFast,
                   {{0, 14},
                    {0.42, 22},
                    {0.6, 20},
                    {0.7, 36},
                    {0.8, 70},
                    {kContact, 94},
                    {kMaxExternal, 92},
                    {kRelease, 95},
                    {1.16, 98},
                    {1.25, 72},
                    {1.4, 52},
                    {1.6, 32},
                    {1.9, 16},
                    {2.4, 14}}};
    k.horizontal = {kFast,
                    {{0, 52},
                     {0.43, 50},
                     {0.6, 20},
                     {0.7, -18},
                     {0.8, -26},
                     {kContact, -22},
                     {0.97, -10},
                     {kMaxExternal, -8},
                     {kRelease, -1},
                     {1.16, 15},
                     {1.25, 85},
                     {1.4, 113},
                     {1.6, 74},
                     {1.9, 44},
                     {2.4, 52}}};
    // Internal rotation is fastest just after the release, when the elbow is almost straight.
    k.external = {kFast,
                  {{0, 20},
                   {0.39, 26},
                   {0.6, -10},
                   {0.72, -20},
                   {0.8, 12},
                   {kContact, 65},
                   {0.96, 122},
                   {kMaxExternal, 173},
                   {1.055, 173},
                   {kRelease, 148},
                   {1.11, 60},
                   {1.15, 34},
                   {1.25, -10},
                   {1.5, 4},
                   {1.9, 2},
                   {2.4, 17},
                   {2.8, 20}}};
    k.elbow = {kFast,
               {{0, 108},
                {0.41, 118},
                {0.6, 72},
                {0.7, 38},
                {0.8, 58},
                {kContact, 90},
                {0.96, 99},
                {kMaxExternal, 83},
                {1.04, 64},
                {kRelease, 25},
                {1.115, 14},
                {1.17, 18},
                {1.3, 36},
                {1.5, 62},
                {1.8, 58},
                {2.3, 98},
                {2.72, 108}}};
    // Every overhand throw ends in pronation, both fastballs and curves.
    k.pronation = {kFast,
                   {{0, 0},
                    {0.5, 0},
                    {0.62, 30},
                    {0.75, 55},
                    {kContact, 40},
                    {kMaxExternal, 0},
                    {kRelease, 14},
                    {1.15, 65},
                    {1.3, 60},
                    {1.7, 25},
                    {2.3, 0}}};
    k.wrist = {kFast,
               {{0, -5},
                {kContact, -15},
                {kMaxExternal, -40},
                {1.045, -44},
                {kRelease, -26},
                {1.13, 24},
                {1.3, 20},
                {1.7, 5},
                {2.3, -5}}};
    k.fingers = {kFast, {{0, 26}, {1.06, 26}, {kRelease, 12}, {1.11, 6}, {1.2, 16}, {1.5, 24}}};
    k.thumb = {kFast, {{0, 32}, {1.06, 32}, {1.1, 5}, {1.3, 12}, {1.8, 32}}};
    return k;
}

// Mirrors the throwing arm until the hands separate, then points at the target and tucks against
// the chest as the trunk rotates.
ArmKeys gloveArmKeys() {
    constexpr double kSlow = 0.04;
    ArmKeys k;
    k.protraction = {kSlow,
                     {{0, 10},
                      {kKneeUp, 10},
                      {0.8, 14},
                      {kContact, 10},
                      {kRelease, -14},
                      {1.4, -6},
                      {1.9, 4},
                      {2.5, 10}}};
    k.elevation = {
        kSlow, {{0, 2}, {0.35, 0}, {0.8, 6}, {kContact, 6}, {kRelease, -2}, {1.5, 0}, {2.5, 0}}};
    k.tilt = {kSlow, {{0, 0}}};
    k.abduction = {kSlow,
                   {{0, 14},
                    {0.42, 22},
                    {0.62, 42},
                    {0.8, 82},
                    {kContact, 86},
                    {0.99, 66},
                    {kRelease, 40},
                    {1.25, 32},
                    {1.5, 28},
                    {1.8, 16},
                    {2.4, 14}}};
    k.horizontal = {kSlow,
                    {{0, 52},
                     {0.45, 50},
                     {0.62, 46},
                     {0.8, 22},
                     {kContact, 14},
                     {0.99, 10},
                     {kRelease, -10},
                     {1.25, -14},
                     {1.5, -8},
                     {1.9, 30},
                     {2.4, 52}}};
    k.external = {kSlow,
                  {{0, 20},
                   {0.41, 26},
                   {0.62, 0},
                   {0.8, -5},
                   {kContact, 8},
                   {0.99, 20},
                   {kRelease, 0},
                   {1.25, -5},
                   {1.5, -5},
                   {2.3, 20}}};
    k.elbow = {kSlow,
               {{0, 108},
                {0.43, 118},
                {0.62, 80},
                {0.8, 28},
                {kContact, 22},
                {0.99, 70},
                {kRelease, 112},
                {1.25, 110},
                {1.5, 72},
                {1.8, 46},
                {2.3, 96},
                {2.8, 108}}};
    k.pronation = {kSlow,
                   {{0, 0},
                    {0.55, 10},
                    {0.85, 60},
                    {kContact, 50},
                    {kRelease, -15},
                    {1.4, 10},
                    {1.8, 20},
                    {2.4, 0}}};
    k.wrist = {kSlow, {{0, -5}, {0.8, 0}, {kContact, 10}, {kRelease, 15}, {1.6, 5}, {2.4, -5}}};
    k.fingers = {kSlow, {{0, 20}, {0.7, 20}, {0.9, 10}, {1.1, 30}, {1.6, 22}}};
    k.thumb = {kSlow, {{0, 15}}};
    return k;
}

} // namespace mannequin
