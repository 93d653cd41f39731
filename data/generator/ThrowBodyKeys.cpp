// SPDX-License-Identifier: MIT
#include "ThrowKeys.h"

#include "ThrowTiming.h"

namespace mannequin {
namespace {

constexpr double kKneeUp = frameTime(kKneeUpFrame);
constexpr double kContact = frameTime(kContactFrame);
constexpr double kMaxExternal = frameTime(kMaxExternalFrame);
constexpr double kRelease = frameTime(kReleaseFrame);

} // namespace

BodyKeys bodyKeys() {
    constexpr double kBody = 0.06;
    constexpr double kTrunk = 0.03;
    BodyKeys k;
    k.x = {kBody,
           {{0, 0},
            {0.2, -0.05},
            {kKneeUp, -0.12},
            {0.60, -0.08},
            {0.75, 0.12},
            {kContact, 0.46},
            {kRelease, 0.61},
            {1.25, 0.73},
            {1.45, 0.82},
            {1.65, 0.85},
            {1.9, 0.74},
            {2.2, 0.44},
            {2.5, 0.12},
            {2.78, 0}}};
    k.y = {kBody,
           {{0, 0.945},
            {kKneeUp, 0.95},
            {0.62, 0.93},
            {0.75, 0.87},
            {0.87, 0.795},
            {0.95, 0.785},
            {kRelease, 0.835},
            {1.3, 0.84},
            {1.5, 0.83},
            {1.7, 0.85},
            {1.95, 0.87},
            {2.22, 0.80},
            {2.5, 0.91},
            {2.78, 0.945}}};
    k.z = {kBody,
           {{0, 0},
            {kContact, 0.02},
            {kRelease, 0.03},
            {1.4, 0.04},
            {1.65, 0.09},
            {2.2, 0.04},
            {2.6, 0}}};
    k.pelvisYaw = {kTrunk,
                   {{0, 0},
                    {0.15, -1},
                    {kKneeUp, -22},
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
                    {kKneeUp, -28},
                    {0.65, -30},
                    {0.8, -27},
                    {kContact, -13},
                    {0.955, 18},
                    {kMaxExternal, 54},
                    {kRelease, 90},
                    {1.16, 108},
                    {1.35, 118},
                    {1.6, 106},
                    {1.9, 76},
                    {2.3, 26},
                    {2.65, 0}}};
    k.thoraxLeanX = {kTrunk,
                     {{0, 0},
                      {kKneeUp, -4},
                      {0.75, -9},
                      {kContact, -6},
                      {kMaxExternal, -5},
                      {kRelease, 37},
                      {1.2, 62},
                      {1.35, 70},
                      {1.5, 60},
                      {1.75, 30},
                      {2.0, 12},
                      {2.4, 3},
                      {2.7, 0}}};
    k.thoraxLeanZ = {kTrunk,
                     {{0, 3},
                      {kKneeUp, 8},
                      {0.65, 10},
                      {kContact, 2},
                      {kMaxExternal, -2},
                      {kRelease, -26},
                      {1.13, -38},
                      {1.3, -16},
                      {1.6, 0},
                      {2.2, 5},
                      {2.7, 3}}};
    k.headYaw = {kTrunk,
                 {{0, 62},
                  {kKneeUp, 40},
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
