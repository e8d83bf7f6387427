#include "viewer/hud.h"

#include <cmath>
#include <cstdio>
#include <osg/Geode>

namespace {

const char FONT[] = "/usr/share/fonts/truetype/dejavu/DejaVuSansMono.ttf";

osg::ref_ptr<osgText::Text> make_text(float size_px, osgText::Text::AlignmentType alignment) {
    osg::ref_ptr<osgText::Text> text = new osgText::Text;
    text->setDataVariance(osg::Object::DYNAMIC);
    text->setCharacterSize(size_px);
    text->setAlignment(alignment);
    text->setColor(osg::Vec4(1, 1, 1, 1));
    text->setDrawMode(osgText::Text::TEXT | osgText::Text::FILLEDBOUNDINGBOX);
    text->setBoundingBoxColor(osg::Vec4(0, 0, 0, 0.5f));
    text->setBoundingBoxMargin(6);
    static const osg::ref_ptr<osgText::Font> font = osgText::readRefFontFile(FONT);
    if (font.valid()) text->setFont(font);
    return text;
}

// Text that did not change is not laid out again.
void set_text(osgText::Text *text, const std::string &said) {
    if (text->getText().createUTF8EncodedString() != said) text->setText(said, osgText::String::ENCODING_UTF8);
}

std::string metres(double length_m) {
    char text[32];
    snprintf(text, sizeof text, length_m < 10 ? "%.2f m" : "%.0f m", length_m);
    return text;
}

std::string count(uint64_t number) { // with a space every three digits
    std::string digits = std::to_string(number);
    for (int at = (int)digits.size() - 3; at > 0; at -= 3) digits.insert((size_t)at, " ");
    return digits;
}

} // namespace

Hud::Hud(const std::string &help_text) : root(new osg::Camera) {
    root->setReferenceFrame(osg::Transform::ABSOLUTE_RF);
    root->setRenderOrder(osg::Camera::POST_RENDER);
    root->setClearMask(GL_DEPTH_BUFFER_BIT);
    root->setAllowEventFocus(false);
    root->setViewMatrix(osg::Matrixd::identity());
    osg::StateSet *state = root->getOrCreateStateSet();
    state->setMode(GL_LIGHTING, osg::StateAttribute::OFF | osg::StateAttribute::PROTECTED);
    state->setMode(GL_DEPTH_TEST, osg::StateAttribute::OFF);
    state->setMode(GL_BLEND, osg::StateAttribute::ON);
    figures = make_text(14, osgText::Text::LEFT_TOP);
    help = make_text(15, osgText::Text::LEFT_CENTER);
    note = make_text(16, osgText::Text::CENTER_BOTTOM);
    help->setText(help_text, osgText::String::ENCODING_UTF8);
    osg::ref_ptr<osg::Geode> geode = new osg::Geode;
    for (const auto &text : {figures, help, note}) geode->addDrawable(text);
    root->addChild(geode);
}

void Hud::resize(double width, double height) {
    if (width == width_px && height == height_px) return;
    width_px = width;
    height_px = height;
    root->setProjectionMatrixAsOrtho2D(0, width, 0, height);
    figures->setPosition(osg::Vec3((float)12, (float)height - 12, 0));
    const osg::BoundingBox box = help->getBoundingBox();
    help->setPosition(osg::Vec3((float)(width - (box.xMax() - box.xMin())) / 2, (float)height / 2, 0));
    note->setPosition(osg::Vec3((float)width / 2, 14, 0));
}

void Hud::update(const std::string &figures_text, const std::string &note_text) {
    figures->setNodeMask(are_figures_shown ? ~0u : 0u);
    help->setNodeMask(is_help_shown ? ~0u : 0u);
    note->setNodeMask(note_text.empty() ? 0u : ~0u);
    if (are_figures_shown) set_text(figures, figures_text);
    set_text(note, note_text);
}

std::string hud_figures(const TerrainFigures &figures, const TerrainSettings &settings, double frames_per_s,
                        bool is_recording) {
    char line[160];
    std::string text;
    if (settings.manual_svo_m > 0)
        snprintf(line, sizeof line, "scale by hand: SVO %s", metres(settings.manual_svo_m).c_str());
    else
        snprintf(line, sizeof line, "%s within %.3g px", settings.measure == SCREE_BY_SVO ? "SVO" : "max error",
                 figures.tolerance_px);
    text += line;
    if (settings.is_frozen) text += ", frozen";
    text += "\nSVO " + metres(figures.finest_svo_m) + " to " + metres(figures.coarsest_svo_m);
    snprintf(line, sizeof line, "\nrungs %d to %d, %u tiles", figures.coarsest_rung, figures.finest_rung,
             figures.tiles_drawn);
    text += line;
    text += "\n" + count(figures.triangles) + " triangles\n" + count(figures.splits) + " splits this frame";
    snprintf(line, sizeof line, "\n%.1f MB loaded, %u tiles on their way", (double)figures.bytes_loaded / 1e6,
             figures.tiles_loading);
    text += line;
    snprintf(line, sizeof line, "\n%.0f fps", frames_per_s);
    text += line;
    if (is_recording) text += "\nrecording";
    return text;
}
