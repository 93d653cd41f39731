// SPDX-License-Identifier: MIT
#include "ThrowKeys.h"

#include "ThrowTiming.h"

namespace mannequin {
namespace {

constexpr double kFoot = 0.03;
constexpr double kKneeUp = frameTime(kKneeUpFrame);
constexpr double kContact = frameTime(kContactFrame);
constexpr double kRelease = frameTime(kReleaseFrame);

} // namespace

FootKeys pivotFootKeys() {
    FootKeys k;
    k.x = {kFoot,
           {{0, -0.19},
            {kContact, -0.19},
            {0.99, -0.09},
            {kRelease, 0.04},
            {1.2, 0.20},
            {1.4, 0.55},
            {1.6, 0.84},
            {1.86, 0.84},
            {2.22, -0.19}}};
    k.z = {kFoot,
           {{0, 0.125},
            {kContact, 0.125},
            {kRelease, 0.14},
            {1.25, 0.30},
            {1.4, 0.38},
            {1.6, 0.36},
            {1.86, 0.36},
            {2.05, 0.28},
            {2.22, 0.125}}};
    k.lift = {kFoot,
              {{0, 0},
               {1.10, 0},
               {1.28, 0.33},
               {1.42, 0.26},
               {1.62, 0},
               {1.86, 0},
               {2.03, 0.10},
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

FootKeys leadFootKeys() {
    FootKeys k;
    k.x = {kFoot,
           {{0, 0.19},
            {0.10, 0.19},
            {kKneeUp, -0.02},
            {0.62, 0.12},
            {0.87, 1.12},
            {2.24, 1.12},
            {2.64, 0.19}}};
    k.z = {kFoot,
           {{0, 0.125},
            {0.10, 0.125},
            {kKneeUp, 0.24},
            {0.66, 0.20},
            {0.87, 0.08},
            {2.24, 0.08},
            {2.64, 0.125}}};
    k.lift = {kFoot,
              {{0, 0},
               {0.10, 0},
               {kKneeUp, 0.46},
               {0.62, 0.31},
               {0.75, 0.12},
               {0.85, 0.01},
               {0.88, 0},
               {2.24, 0},
               {2.44, 0.10},
               {2.64, 0}}};
    k.yaw = {kFoot,
             {{0, 0}, {0.12, 0}, {kKneeUp, -20}, {0.65, 5}, {0.87, 66}, {2.24, 66}, {2.62, 0}}};
    k.heel = {kFoot,
              {{0, 0},
               {0.06, 0},
               {0.2, 18},
               {kKneeUp, 30},
               {0.65, 10},
               {0.80, -14},
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
