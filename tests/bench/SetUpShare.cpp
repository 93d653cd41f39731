// SPDX-License-Identifier: MIT
#include "SetUpShare.h"

#include <osgSkin/DeformJob>

#include <algorithm>
#include <ctime>

namespace bench {

namespace {

/// A body's skin with every vertex `times` times, in memory of its own.
class UpdatedSkin {
public:
    UpdatedSkin(const Body& body, std::size_t times) : _body(body) {
        std::vector<glm::vec3> positions, normals;
        std::vector<std::uint32_t> source;
        for (std::size_t i = 0; i < times; ++i) {
            positions.insert(positions.end(), body.positions.begin(), body.positions.end());
            normals.insert(normals.end(), body.normals.begin(), body.normals.end());
            for (std::uint32_t v = 0; v < body.positions.size(); ++v) source.push_back(v);
        }
        _model =
            osgSkin::SkinModel::createInBestOrder(body.binding, positions, normals, source).model;
        _outputs.resize(2 * positions.size());
    }

    double vertexCount() const { return static_cast<double>(_model->vertexCount()); }

    /// Seconds that an update takes, of several: the caches get used to it.
    double update(std::size_t frame, osgSkin::Pose& pose) {
        constexpr std::size_t kUpdates = 20;
        osgSkin::DeformJob job;
        job.model = _model.get();
        job.pose = &pose;
        job.positionCount = job.normalCount = _model->vertexCount();
        job.positions = _outputs.data();
        job.normals = job.positions + job.positionCount;
        const std::clock_t start = std::clock();
        for (std::size_t i = 0; i < kUpdates; ++i) {
            const auto& skinning = _body.skinning[(frame + i) % _body.skinning.size()];
            pose.set(skinning.data(), skinning.size());
            job.run();
            benchmark::ClobberMemory();
        }
        return static_cast<double>(std::clock() - start) / (CLOCKS_PER_SEC * kUpdates);
    }

private:
    const Body& _body;
    osg::ref_ptr<const osgSkin::SkinModel> _model;
    std::vector<glm::vec3> _outputs;
};

double median(std::vector<double> numbers) {
    const auto middle = numbers.begin() + static_cast<std::ptrdiff_t>(numbers.size() / 2);
    std::nth_element(numbers.begin(), middle, numbers.end());
    return *middle;
}

} // namespace

// How fast a skin is depends on where its memory happens to be, so there are several; what is told
// is the median of them, and how far they are apart.
void setUpShare(benchmark::State& state, Kind kind, Larger larger) {
    constexpr std::size_t kSkins = 9, kRounds = 25;
    const bool finer = larger == Larger::FinerMesh;
    const Body& body = bench::body(1, kind);
    osgSkin::Pose pose(body.binding.joints, body.binding.correctives.inputs.size());
    std::vector<UpdatedSkin> small, large;
    for (std::size_t i = 0; i < kSkins; ++i) {
        small.emplace_back(body, 1);
        large.emplace_back(finer ? bench::body(3, kind) : body, finer ? 1 : 2);
    }
    const double ratio = large.front().vertexCount() / small.front().vertexCount();
    for ([[maybe_unused]] auto iteration : state) {
        std::vector<double> rests, updates, shares;
        for (std::size_t i = 0; i < kSkins; ++i) {
            std::vector<double> smalls, larges;
            for (std::size_t round = 0; round < kRounds; ++round) {
                smalls.push_back(small[i].update(round, pose));
                larges.push_back(large[i].update(round, pose));
            }
            const double update = median(smalls);
            updates.push_back(update);
            rests.push_back(update - (median(larges) - update) / (ratio - 1.0));
            shares.push_back(100.0 * rests.back() / update);
        }
        state.SetIterationTime(std::max(0.0, median(rests)));
        state.counters["update us"] = 1e6 * median(updates);
        state.counters["set-up %"] = median(shares);
        state.counters["least %"] = *std::min_element(shares.begin(), shares.end());
        state.counters["most %"] = *std::max_element(shares.begin(), shares.end());
    }
}

} // namespace bench
