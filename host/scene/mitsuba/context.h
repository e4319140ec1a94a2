// What the plugins of a scene share while the neutral scene is built.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "scene/mitsuba/document.h"
#include "scene/mitsuba/mesh_attributes.h"
#include "scene/scene.h"

namespace wavelobe::mitsuba {

// What a <bsdf> stands for before a shape uses it: only used materials enter the scene.
struct Bsdf {
    std::shared_ptr<const Material> front;
    std::shared_ptr<const Material> back;  // null: black
    bool transmissive = false;
    Opacity opacity{};
    bool turned = false;  // opaque on both sides: seen from behind it is turned over
    std::set<AttributeUse> attributes{};  // that the shape must have
};

struct Context {
    Context(const Document& source, Scene& target, Faults& found)
        : document(source), scene(target), faults(found) {}

    const Document& document;
    Scene& scene;
    Faults& faults;

    // Objects with several references are built once.
    std::map<const Object*, Bsdf> bsdfs;
    std::map<const Object*, std::shared_ptr<const Texture>> textures;
    std::map<const Object*, std::shared_ptr<const Texture>> scalar_textures;
    std::map<std::string, std::shared_ptr<const Texture>> bitmaps;  // by file and options
    std::map<const Material*, int> material_indices;
    std::map<const Texture*, AttributeUse> attribute_textures;
    std::set<AttributeUse> attributes;  // that the object asks for which is being read, so far
    MeshAttributes mesh_attributes;
    std::map<const Object*, int> groups;
    std::map<const Object*, int> media;
    std::shared_ptr<const Material> default_material, black_material;

    std::set<const Object*> held_by_shapes;  // among them area emitters that stand beside the shapes they shine from

    int bsdf_levels = 0;  // of nested ones that are being read
    bool absorbs_media = false;  // the integrator sees media
    int environments = 0;
    int sensors = 0;
    int integrators = 0;
};

// How a colour parameter is used: reflectances lie in [0, 1], emission has its own uniform spectrum.
enum class ColourUse { reflectance, unbounded, emission };

// ---- spectra.cpp ------------------------------------------------------------------------------------

// The colour of a nested spectrum such as `blackbody`; nothing for other objects. One that cannot be read is black, the
// fault being on record.
std::optional<Rgb> read_spectrum_object(Context& context, const Object& object, ColourUse use);
std::vector<std::string> spectrum_types();

// ---- textures.cpp -----------------------------------------------------------------------------------

enum class TextureUse { colour, scalar };
// Null when the texture is refused; the fault is on record.
std::shared_ptr<const Texture> read_texture(Context& context, const Object& object, TextureUse use);
std::vector<std::string> texture_types();

// ---- bsdfs.cpp --------------------------------------------------------------------------------------

Bsdf read_bsdf(Context& context, const Object& object);
// Of a shape without one; what emits is black otherwise.
Bsdf default_bsdf(Context& context, bool emitter);
std::vector<std::string> bsdf_types();

// ---- shapes.cpp -------------------------------------------------------------------------------------

void read_shape(Context& context, const Object& object);
// A shape that is neither a group nor an instance; empty where it does not enter the scene.
std::optional<Shape> build_shape(Context& context, const Object& object);
std::vector<std::string> shape_types();

// ---- media.cpp --------------------------------------------------------------------------------------

class Query;
// Index into Scene::media; -1 where it is refused or without effect.
int read_medium(Context& context, const Object& object);
// The media that a shape parts.
std::optional<MediumBoundary> read_boundary(Query& query);
// The medium that a sensor or light is in; -1: none.
int read_surrounding_medium(Query& query);
std::vector<std::string> medium_types();
// Of Mitsuba 3 and 0.x, supported or not: a scene may hold some that nothing refers to.
std::vector<std::string> known_medium_types();
std::vector<std::string> known_phase_types();
std::vector<std::string> known_volume_types();

// ---- instances.cpp ----------------------------------------------------------------------------------

// The index of the group, which is read once; -1 where it is refused.
int read_shape_group(Context& context, const Object& object);
void read_instance(Context& context, const Object& object);
void read_merged(Context& context, const Object& object);

// ---- emitters.cpp -----------------------------------------------------------------------------------

void read_emitter(Context& context, const Object& object);
std::optional<AreaEmitter> read_area_emitter(Context& context, const Object& object);
std::vector<std::string> emitter_types();

// ---- sensor.cpp -------------------------------------------------------------------------------------

void read_sensor(Context& context, const Object& object);
std::vector<std::string> sensor_types();
std::vector<std::string> sampler_types();

// ---- film.cpp ---------------------------------------------------------------------------------------

Film read_film(Context& context, const Object& object);
std::vector<std::string> film_types();
std::vector<std::string> filter_types();

// ---- integrator.cpp ---------------------------------------------------------------------------------

void read_integrator(Context& context, const Object& object);
// Whether that integrator, or one that it holds, sees media.
bool sees_media(const Object& integrator);
std::vector<std::string> integrator_types();

}  // namespace wavelobe::mitsuba
