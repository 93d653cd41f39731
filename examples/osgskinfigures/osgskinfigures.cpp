// SPDX-License-Identifier: MIT
#include "Body.h"
#include "CommandLine.h"
#include "DataFolder.h"
#include "Figures.h"

#include <osgDB/FileUtils>

#include <exception>
#include <iostream>

namespace {

void writeFigures(figures::Body& body, const std::string& out, bool painted) {
    if (!osgDB::makeDirectory(out)) throw std::runtime_error(out + ": cannot be made");
    using figures::writePicture;
    writePicture(*figures::regionFigure(body), out + "/fig1_regions.png");
    writePicture(*figures::splitFigure(), out + "/fig2_split.png");
    writePicture(*figures::ratioFigure(body), out + "/fig3_ratios.png");
    std::vector<figures::Tile> all;
    std::size_t columns = 1;
    for (const figures::Comparison& row : figures::comparisons(body, painted)) {
        columns = row.tiles.size();
        writePicture(*figures::tiled(row.tiles, columns), out + "/compare_" + row.name + ".png");
        all.insert(all.end(), row.tiles.begin(), row.tiles.end());
    }
    writePicture(*figures::tiled(all, columns), out + "/compare.png");
    if (body.character.motions.empty())
        std::cerr << "no motion, so no fig4_throw.png" << std::endl;
    else
        writePicture(*figures::throwFigure(body), out + "/fig4_throw.png");
}

} // namespace

int main(int argc, char** argv) {
    example::CommandLine line(
        "osgskinfigures",
        "The paper's figures, and osgSkin beside linear blending and dual quaternions, "
        "as pictures.",
        "Needs an X display; Xvfb will do.");
    std::string out;
    std::string file = example::dataFolder() + "/thrower.skin";
    std::string weights;
    line.add("--out", out, "folder for the pictures, made if need be").required();
    line.add("--weights", weights,
             "painted weights (JSON) for the peers; without: from our ratios");
    line.add("CHARACTER", file, example::kCharacterHelp);
    return line.run(argc, argv, [&] {
        line.parse(argc, argv);
        osgSkin::LoadOptions options;
        options.shapes = osgSkin::BindOptions::Shapes::Fast;
        figures::Body body(figures::load(file, options), weights);
        writeFigures(body, out, !weights.empty());
        return 0;
    });
}
