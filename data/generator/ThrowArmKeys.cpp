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
                   {{0, 0},
                    {0.65, -2},
                    {kContact, 10},
                    {kMaxExternal, 13},
                    {kRelease, 10},
                    {1.3, -4},
                    {1.7, 0}}};
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
                    {kKneeUp, 22},
                    {0.60, 20},
                    {0.70, 36},
                    {0.80, 70},
                    {kContact, 94},
                    {kMaxExternal, 92},
                    {kRelease, 94},
                    {1.16, 96},
                    {1.25, 72},
                    {1.4, 52},
                    {1.6, 36},
                    {1.9, 22},
                    {2.4, 14}}};
    k.horizontal = {kFast,
                    {{0, 52},
                     {kKneeUp, 50},
                     {0.60, 20},
                     {0.70, -18},
                     {0.8, -26},
                     {kContact, -22},
                     {0.97, -10},
                     {kMaxExternal, -12},
                     {kRelease, -1},
                     {1.16, 19},
                     {1.25, 85},
                     {1.4, 118},
                     {1.6, 100},
                     {1.9, 62},
                     {2.4, 52}}};
    k.external = {kFast,
                  {{0, 20},
                   {kKneeUp, 14},
                   {0.60, -10},
                   {0.72, -20},
                   {0.80, 12},
                   {kContact, 65},
                   {0.96, 122},
                   {kMaxExternal, 173},
                   {1.055, 173},
                   {kRelease, 145},
                   {1.11, 76},
                   {1.15, 34},
                   {1.25, -10},
                   {1.5, -22},
                   {1.9, 4},
                   {2.4, 20}}};
    k.elbow = {kFast,
               {{0, 108},
                {kKneeUp, 112},
                {0.60, 72},
                {0.70, 38},
                {0.80, 58},
                {kContact, 90},
                {0.96, 99},
                {kMaxExternal, 83},
                {1.04, 55},
                {kRelease, 27},
                {1.115, 16},
                {1.17, 18},
                {1.3, 36},
                {1.5, 46},
                {1.8, 62},
                {2.3, 104},
                {2.6, 108}}};
    k.pronation = {kFast,
                   {{0, 0},
                    {0.5, 0},
                    {0.62, 30},
                    {0.75, 55},
                    {kContact, 40},
                    {kMaxExternal, 0},
                    {kRelease, 12},
                    {1.15, 65},
                    {1.3, 60},
                    {1.7, 25},
                    {2.3, 0}}};
    k.wrist = {kFast,
               {{0, -5},
                {kContact, -15},
                {kMaxExternal, -40},
                {1.045, -44},
                {kRelease, -22},
                {1.13, 27},
                {1.3, 20},
                {1.7, 5},
                {2.3, -5}}};
    k.fingers = {kFast, {{0, 26}, {1.06, 26}, {kRelease, 12}, {1.11, 6}, {1.2, 16}, {1.5, 24}}};
    k.thumb = {kFast, {{0, 25}, {1.06, 25}, {1.10, 5}, {1.3, 12}, {1.8, 25}}};
    return k;
}

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
    k.elevation = {kSlow, {{0, 0}, {0.8, 6}, {kContact, 6}, {kRelease, -2}, {1.5, 0}}};
    k.tilt = {kSlow, {{0, 0}}};
    k.abduction = {kSlow,
                   {{0, 14},
                    {kKneeUp, 22},
                    {0.62, 42},
                    {0.8, 82},
                    {kContact, 86},
                    {0.99, 66},
                    {kRelease, 40},
                    {1.25, 32},
                    {1.5, 36},
                    {1.8, 24},
                    {2.4, 14}}};
    k.horizontal = {kSlow,
                    {{0, 52},
                     {kKneeUp, 50},
                     {0.62, 46},
                     {0.8, 22},
                     {kContact, 14},
                     {0.99, 10},
                     {kRelease, -10},
                     {1.25, -22},
                     {1.5, -10},
                     {1.9, 40},
                     {2.4, 52}}};
    k.external = {kSlow,
                  {{0, 20},
                   {kKneeUp, 14},
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
                {kKneeUp, 112},
                {0.62, 80},
                {0.8, 28},
                {kContact, 22},
                {0.99, 70},
                {kRelease, 112},
                {1.25, 110},
                {1.5, 80},
                {1.8, 64},
                {2.3, 102},
                {2.6, 108}}};
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
