// The OpenSceneGraph plugin for streams: osgviewer TILE.scree, osgconv TILE.scree OUT.osgt, and for all tiles together
// osgviewer OUT/stream/scree.json.scree (OpenSceneGraph goes by the last extension).
//
// Options (osgviewer -O "error=5"). A tile: svo=M or error=M for the coarsest rung that is good enough, rung=L for one
// of the ladder; without any, the finest. All tiles: see viewer/terrain_words.h.
#include "viewer/terrain_node.h"
#include "viewer/terrain_words.h"
#include "viewer/tile_file_io.h"
#include "viewer/tile_node.h"

#include <osg/CoordinateSystemNode>
#include <osgDB/FileNameUtils>
#include <osgDB/FileUtils>
#include <osgDB/ReadFile>
#include <osgDB/Registry>
#include <osgDB/fstream>

#include <cstdlib>
#include <memory>
#include <sstream>

namespace {

// Which rung the options ask for; false when they cannot be understood.
bool rung_of(const scree_stream_header *header, const osgDB::Options *options, uint32_t *rung) {
    std::istringstream words(options != nullptr ? options->getOptionString() : "");
    *rung = header->rung_count - 1;
    for (std::string word; words >> word;) {
        size_t equals = word.find('=');
        if (equals == std::string::npos) continue; // another plugin's
        std::string name = word.substr(0, equals);
        char *end;
        double value = strtod(word.c_str() + equals + 1, &end);
        bool is_ours = name == "svo" || name == "error" || name == "rung";
        if (is_ours && (*end != '\0' || end == word.c_str() + equals + 1 || !(value >= -1e6 && value <= 1e9)))
            return false;
        if (name == "svo") *rung = scree_stream_rung_of_svo(header, value);
        if (name == "error") *rung = scree_stream_rung_of_error(header, value);
        if (name == "rung") *rung = scree_stream_rung_of_ladder(header, (int32_t)value);
    }
    return true;
}

class ReaderWriterScree : public osgDB::ReaderWriter {
  public:
    ReaderWriterScree() {
        supportsExtension("scree", "terrain streams of Scree");
        supportsOption("svo=M", "the coarsest rung whose smallest visible object is at most M metres");
        supportsOption("error=M", "the coarsest rung whose largest error is at most M metres");
        supportsOption("rung=L", "a rung of the scale ladder");
        for (const TerrainWord &word : terrain_words()) supportsOption(word.form, word.meaning);
    }

    const char *className() const override { return "Scree stream reader"; }

    ReadResult readObject(const std::string &name, const Options *options) const override {
        return readNode(name, options);
    }

    ReadResult readNode(const std::string &name, const Options *options) const override {
        if (!acceptsExtension(osgDB::getLowerCaseFileExtension(name))) return ReadResult::FILE_NOT_HANDLED;
        std::string whole = osgDB::getNameLessExtension(name);
        if (osgDB::getLowerCaseFileExtension(whole) == "json") return terrain(whole, options);
        std::string path = osgDB::findDataFile(name, options);
        if (path.empty()) return ReadResult::FILE_NOT_FOUND;
        osgDB::ifstream file(path.c_str(), std::ios::in | std::ios::binary);
        return read(file, path, options);
    }

    ReadResult readObject(std::istream &file, const Options *options) const override { return readNode(file, options); }

    ReadResult readNode(std::istream &file, const Options *options) const override {
        return read(file, "the stream", options);
    }

  private:
    // Manipulators learn from the node above it where up is on a globe.
    static ReadResult terrain(const std::string &name, const Options *options) {
        TerrainOptions opening;
        std::string error, found = osgDB::findDataFile(name, options);
        if (!terrain_words_read(options != nullptr ? options->getOptionString() : "", &opening, &error))
            return ReadResult(error);
        osg::ref_ptr<TerrainNode> node = TerrainNode::open(found.empty() ? name : found, opening, &error);
        if (node == nullptr) return ReadResult(error);
        if (!node->world().is_geodetic()) return ReadResult(node.get());
        osg::ref_ptr<osg::CoordinateSystemNode> globe = new osg::CoordinateSystemNode("WKT", "EPSG:4326");
        globe->setEllipsoidModel(new osg::EllipsoidModel);
        globe->addChild(node);
        return ReadResult(globe.get());
    }

    static ReadResult read(std::istream &file, const std::string &name, const Options *options) {
        scree_error error = {};
        scree_player *made = nullptr;
        scree_player_new(nullptr, &made, &error);
        Player player(made);
        scree_status status = error.status == SCREE_OK ? SCREE_MORE : error.status;
        char piece[65536];
        while (status == SCREE_MORE && file.good()) {
            file.read(piece, sizeof piece);
            status = scree_player_push(player.get(), piece, (size_t)file.gcount(), &error);
        }
        if (status < 0) return ReadResult(name + ": " + error.text);
        if (status == SCREE_MORE) return ReadResult(name + ": the stream is cut off; fetch it again");
        uint32_t rung;
        if (!rung_of(scree_player_header(player.get()), options, &rung))
            return ReadResult(name + ": svo=, error= and rung= want a number");
        return ReadResult(tile_node(player.get(), rung).get());
    }
};

} // namespace

REGISTER_OSGPLUGIN(scree, ReaderWriterScree)
