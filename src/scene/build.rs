//! From the fields of a scene file to a scene, with every check that TOML does not make.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::Vec3;
use toml::Spanned;

use super::entries::{LightEntry, MaterialEntry, MeshEntry, SceneEntry, SurfaceEntry};
use super::fields::MAX_COORDINATE;
use super::mesh;
use super::source::{Files, Text};
use super::{
    AreaLight, Camera, Geometry, Light, LightShape, Material, PlacedTexture, Scattering, Scene, Sphere,
    Triangle,
};
use crate::error::{Error, Result};

/// Reads the text of a scene file.
///
/// # Errors
/// [`Error::File`] with line and field.
pub(super) fn scene(text: &Text<'_>, files: &Files) -> Result<Scene> {
    let entry: SceneEntry = toml::from_str(text.content).map_err(|error| text.not_a_scene(&error))?;
    let mut builder = Builder {
        text,
        files,
        materials: Vec::new(),
        geometry: Geometry::default(),
        mesh_lights: Vec::new(),
    };
    let camera = builder.camera(&entry)?;
    let mut names = BTreeMap::new();
    for (name, material) in &entry.materials {
        names.insert(name.get_ref().as_str(), index(builder.materials.len()));
        let material = builder.material(name, material)?;
        builder.materials.push(material);
    }
    for (name, surface) in &entry.surfaces {
        builder.surface(name, surface, &names)?;
    }
    if builder.geometry.surfaces.is_empty() {
        return Err(Error::file(
            text.path,
            "the scene has no surface",
            "add one, for example [surfaces.floor] with material and quads",
        ));
    }
    let mut lights = Vec::new();
    for (name, light) in &entry.lights {
        if let Some(same) = entry.surfaces.keys().find(|surface| surface == &name) {
            let field = format!("lights.{}", name.get_ref());
            let problem = format!("the surface of line {} has the same name", text.line(&same.span()));
            return Err(text.error(&name.span(), &field, problem, "give one of them another name"));
        }
        lights.extend(builder.light(name, light)?);
    }
    let Builder { materials, geometry, mesh_lights, .. } = builder;
    lights.extend(mesh_lights);
    lights.extend(shining(&geometry, &materials));
    Ok(Scene::new(entry.title, entry.units, camera, lights, materials, geometry))
}

/// A light for each surface that shines, and each of its materials.
fn shining(geometry: &Geometry, materials: &[Material]) -> Vec<Light> {
    let mut groups: BTreeMap<(u32, u32), Vec<&Triangle>> = BTreeMap::new();
    for triangle in &geometry.triangles {
        if materials[triangle.material as usize].emission != Vec3::ZERO {
            groups.entry((triangle.surface, triangle.material)).or_default().push(triangle);
        }
    }
    let light = |((surface, number), triangles): ((u32, u32), Vec<&Triangle>)| {
        let material = &materials[number as usize];
        let corners = triangles.iter().map(|triangle| geometry.corners(triangle)).collect();
        let texture = material.emission_texture.as_ref().map(|texture| PlacedTexture {
            texture: Arc::clone(texture),
            coordinates: triangles
                .iter()
                .map(|triangle| {
                    triangle.vertices.map(|vertex| geometry.vertices[vertex as usize].coordinates[1])
                })
                .collect(),
        });
        Light {
            name: geometry.surfaces[surface as usize].clone(),
            of: Some([surface, number]),
            shape: LightShape::Area(AreaLight::new(corners, material.emission, texture)),
        }
    };
    groups.into_iter().map(light).collect()
}

fn index(length: usize) -> u32 {
    u32::try_from(length).expect("fewer than 2^32 things fit into memory")
}

/// Collects materials and geometry.
struct Builder<'a> {
    text: &'a Text<'a>,
    files: &'a Files,
    materials: Vec<Material>,
    geometry: Geometry,
    /// Lights that came with mesh files.
    mesh_lights: Vec<Light>,
}

impl Builder<'_> {
    fn camera(&self, entry: &SceneEntry) -> Result<Camera> {
        let camera = &entry.camera;
        let direction = self.text.direction(&camera.direction, "camera.direction")?;
        let up = self.text.direction(&camera.up, "camera.up")?;
        if direction.cross(up).length() < 1e-6 {
            let problem = "it is along camera.direction, so that the picture has no side";
            return Err(self.text.error(&camera.up.span(), "camera.up", problem, "choose another up"));
        }
        let field = "camera.vertical_fov_degrees";
        let fov = self.text.number(&camera.vertical_fov_degrees, field, 0.01, 179.0)?;
        let position =
            self.text.place(camera.position.span(), *camera.position.get_ref(), "camera.position")?;
        Ok(Camera { position, direction, up, vertical_fov_degrees: fov })
    }

    /// A light that has no body; one that has becomes a surface.
    fn light(&mut self, name: &Spanned<String>, entry: &LightEntry) -> Result<Option<Light>> {
        let field = |field: &str| format!("lights.{}.{field}", name.get_ref());
        let wrong = |problem: &str| {
            let remedy = "give quad and radiance, or point and intensity; with a point also direction and \
                          angle_degrees, which make it a spot";
            Err(self.text.error(&name.span(), &format!("lights.{}", name.get_ref()), problem, remedy))
        };
        let shape = match entry {
            LightEntry {
                quad: Some(quad),
                radiance: Some(radiance),
                point: None,
                intensity: None,
                direction: None,
                angle_degrees: None,
            } => {
                let emission = self.text.colour(radiance, &field("radiance"), f64::from(f32::MAX))?;
                let halves = self.text.quad(quad, &field("quad"))?;
                let (name, scattering) = (name.get_ref().clone(), Scattering::Lambert(Vec3::ZERO));
                let (surface, material) = (index(self.geometry.surfaces.len()), index(self.materials.len()));
                self.geometry.surfaces.push(name.clone());
                self.materials.push(Material::plain(name, scattering, emission));
                for half in halves {
                    self.geometry.push_flat(half, surface, material);
                }
                return Ok(None);
            }
            LightEntry {
                quad: None, radiance: None, point: Some(point), intensity: Some(intensity), ..
            } => {
                let position = self.text.place(point.span(), *point.get_ref(), &field("point"))?;
                let intensity = self.text.colour(intensity, &field("intensity"), f64::from(f32::MAX))?;
                let (direction, half_angle) = match (&entry.direction, &entry.angle_degrees) {
                    (None, None) => (Vec3::Y, std::f32::consts::PI),
                    (Some(direction), Some(angle)) => {
                        let angle = self.text.number(angle, &field("angle_degrees"), 0.01, 180.0)?;
                        (self.text.direction(direction, &field("direction"))?, angle.to_radians())
                    }
                    _ => return wrong("a spot has both direction and angle_degrees"),
                };
                LightShape::Point { position, direction, half_angle, intensity }
            }
            _ => return wrong("these fields together make no light"),
        };
        Ok(Some(Light { name: name.get_ref().clone(), of: None, shape }))
    }

    fn material(&self, name: &Spanned<String>, entry: &MaterialEntry) -> Result<Material> {
        let field = |field: &str| format!("materials.{}.{field}", name.get_ref());
        let emission = match &entry.emission {
            Some(emission) => self.text.colour(emission, &field("emission"), f64::from(f32::MAX))?,
            None => Vec3::ZERO,
        };
        let scattering = match (&entry.lambert, &entry.mirror, &entry.dielectric, &entry.thin_dielectric) {
            (Some(reflectance), None, None, None) => {
                Scattering::Lambert(self.text.colour(reflectance, &field("lambert"), 1.0)?)
            }
            (None, Some(reflectance), None, None) => {
                Scattering::Mirror(self.text.colour(reflectance, &field("mirror"), 1.0)?)
            }
            (None, None, Some(index), None) => {
                Scattering::Dielectric { index: self.text.number(index, &field("dielectric"), 0.1, 10.0)? }
            }
            (None, None, None, Some(index)) => Scattering::ThinDielectric {
                index: self.text.number(index, &field("thin_dielectric"), 0.1, 10.0)?,
                transmittance: Vec3::ONE,
            },
            _ => {
                let (field, problem) =
                    (format!("materials.{}", name.get_ref()), "not exactly one kind is given");
                let remedy = "give one of lambert, mirror, dielectric and thin_dielectric";
                return Err(self.text.error(&name.span(), &field, problem, remedy));
            }
        };
        Ok(Material::plain(name.get_ref().clone(), scattering, emission))
    }

    fn surface(
        &mut self,
        name: &Spanned<String>,
        entry: &SurfaceEntry,
        names: &BTreeMap<&str, u32>,
    ) -> Result<()> {
        let field = |field: &str| format!("surfaces.{}.{field}", name.get_ref());
        let whole = format!("surfaces.{}", name.get_ref());
        if entry.quads.is_empty() && entry.spheres.is_empty() && entry.mesh.is_none() {
            let remedy = "give at least one of quads, spheres and mesh";
            return Err(self.text.error(&name.span(), &whole, "the surface has no shape", remedy));
        }
        let material =
            entry.material.as_ref().map(|material| self.known(material, names, &field("material")));
        let material = material.transpose()?;
        let surface = index(self.geometry.surfaces.len());
        self.geometry.surfaces.push(name.get_ref().clone());

        let needed = || {
            let remedy = "give material = \"NAME\"; a mesh file with materials of its own may do without";
            self.text.error(&name.span(), &whole, "the surface has no material", remedy)
        };
        for (number, quad) in entry.quads.iter().enumerate() {
            let material = material.ok_or_else(needed)?;
            for half in self.text.quad(quad, &format!("{}[{number}]", field("quads")))? {
                self.geometry.push_flat(half, surface, material);
            }
        }
        for (number, sphere) in entry.spheres.iter().enumerate() {
            let material = material.ok_or_else(needed)?;
            let field = format!("{}[{number}]", field("spheres"));
            let centre = self.text.place(
                sphere.centre.span(),
                *sphere.centre.get_ref(),
                &format!("{field}.centre"),
            )?;
            let radius =
                self.text.number(&sphere.radius, &format!("{field}.radius"), 1e-9, MAX_COORDINATE)?;
            if self.materials[material as usize].emission != Vec3::ZERO {
                let remedy = "give the sphere another material, or make the light of quads or a mesh";
                return Err(self.text.error(&sphere.radius.span(), &field, "a sphere can't shine", remedy));
            }
            self.geometry.spheres.push(Sphere { centre, radius, surface, material });
        }
        if let Some(mesh) = &entry.mesh {
            self.mesh(mesh, &field("mesh"), surface, material)?;
        }
        Ok(())
    }

    fn mesh(&mut self, entry: &MeshEntry, field: &str, surface: u32, material: Option<u32>) -> Result<()> {
        let file = entry.file.get_ref();
        let refuse = |(problem, remedy): (String, &str)| {
            self.text.error(
                &entry.file.span(),
                &format!("{field}.file"),
                format!("{file}: {problem}"),
                remedy,
            )
        };
        let mut mesh = mesh::load(self.files, file, material.is_none()).map_err(refuse)?;
        if material.is_none() && mesh.parts.iter().any(|part| part.material.is_none()) {
            let problem = "parts of the mesh have no material, nor has the surface".to_owned();
            return Err(refuse((problem, "give the surface a material")));
        }
        let scale = entry.scale.as_ref();
        let scale = scale.map_or(Ok(1.0), |scale| {
            self.text.number(scale, &format!("{field}.scale"), 1e-9, MAX_COORDINATE)
        })?;
        let translate = match &entry.translate {
            Some(by) => self.text.place(by.span(), *by.get_ref(), &format!("{field}.translate"))?,
            None => Vec3::ZERO,
        };
        for part in &mut mesh.parts {
            for position in &mut part.positions {
                *position = *position * scale + translate;
            }
            // Colours of vertices belong to the file's materials.
            if material.is_some() {
                part.colours.clear();
            }
        }
        let first = index(self.materials.len());
        let added = mesh::add(&mesh, &mut self.geometry, entry.smooth, surface, |part| {
            material.or(part.map(|own| first + own)).unwrap_or_else(|| unreachable!("checked above"))
        });
        let dropped = added.map_err(refuse)?;
        if dropped > 0 {
            mesh.left_out.push(format!("{dropped} triangles without area"));
        }
        mesh::tell(file, &mesh.left_out);
        for mut light in std::mem::take(&mut mesh.lights) {
            if let LightShape::Point { position, .. } = &mut light.shape {
                *position = *position * scale + translate;
                if !mesh::is_possible(position) {
                    let problem = format!("the light \"{}\" is at {position}", light.name);
                    return Err(refuse((problem, "scale the mesh down")));
                }
            }
            self.mesh_lights.push(light);
        }
        if material.is_none() {
            self.materials.append(&mut mesh.materials);
        }
        Ok(())
    }

    /// The index of a material by its name.
    fn known(&self, name: &Spanned<String>, names: &BTreeMap<&str, u32>, field: &str) -> Result<u32> {
        names.get(name.get_ref().as_str()).copied().ok_or_else(|| {
            let problem = format!("there is no material \"{}\"", name.get_ref());
            let known = names.keys().copied().collect::<Vec<_>>().join(", ");
            let remedy = if known.is_empty() {
                "add it, for example [materials.white] with lambert = [0.7, 0.7, 0.7]".to_owned()
            } else {
                format!("use one of: {known}")
            };
            self.text.error(&name.span(), field, problem, remedy)
        })
    }
}
