//! MTL: the materials of a file, as far as a scene can show them.
//!
//! Illumination models 4, 6, 7 and 9 are glass, 3, 5 and 8 mirrors, and others diffuse
//! (<https://paulbourke.net/dataformats/mtl/>). Lines that are not needed for that are not checked, so that
//! faults in them do no harm.

use glam::Vec3;

use super::lines::{Line, Name, lines, shown};
use crate::scene::mesh::Problem;
use crate::scene::{Material, Scattering};

/// `Kd` and `Ks` of a material that has none, as in the format's oldest descriptions and in Blender.
pub(super) const DEFAULT_DIFFUSE: f32 = 0.8;
const DEFAULT_SPECULAR: f32 = 1.0;
/// Index of refraction of glass that has no `Ni`.
const DEFAULT_INDEX: f32 = 1.5;
/// Statements that name an image which is not read.
const OTHER_TEXTURES: [&str; 11] =
    ["map_d", "map_Ks", "map_Bump", "bump", "norm", "disp", "decal", "refl", "map_Ns", "map_Pr", "map_Pm"];

/// A material as its file has it.
pub(super) struct Entry<'a> {
    pub(super) name: Name,
    /// The line that opens it.
    pub(super) line: usize,
    statements: Vec<Line<'a>>,
}

/// All materials of a file. What stands before the first belongs to none.
pub(super) fn entries(content: &[u8]) -> Vec<Entry<'_>> {
    let mut entries: Vec<Entry<'_>> = Vec::new();
    for line in lines(content) {
        if line.keyword().eq_ignore_ascii_case(b"newmtl") {
            entries.push(Entry { name: line.name(), line: line.number, statements: Vec::new() });
        } else if let Some(entry) = entries.last_mut() {
            entry.statements.push(line);
        }
    }
    entries
}

/// The grey of what has no material or colour of its own.
pub(super) fn grey(name: String) -> Material {
    Material::plain(name, Scattering::Lambert(Vec3::splat(DEFAULT_DIFFUSE)), Vec3::ZERO)
}

impl Entry<'_> {
    /// The material, named `name`, and what of it is left out or taken by default.
    ///
    /// # Errors
    /// The line and field that are not possible, without the file.
    pub(super) fn material(&self, name: String) -> Result<(Material, Vec<String>), Problem> {
        let mut notes = self.other_textures();
        let mut reflectance = |field: &'static str, default: f32| {
            if let Some(line) = self.last(field) {
                return colour(line, 1.0);
            }
            // An image is all of the colour then.
            if field == "Kd" && self.has("map_Kd") {
                return Ok(Vec3::ONE);
            }
            notes.push(format!("no {field}, {default} is taken"));
            Ok(Vec3::splat(default))
        };
        let model = self.number("illum", 0.0, 10.0)?.unwrap_or(2.0);
        let scattering = if [4.0, 6.0, 7.0, 9.0].contains(&model) {
            Scattering::Dielectric { index: self.number("Ni", 0.1, 10.0)?.unwrap_or(DEFAULT_INDEX) }
        } else if [3.0, 5.0, 8.0].contains(&model) {
            Scattering::Mirror(reflectance("Ks", DEFAULT_SPECULAR)?)
        } else {
            Scattering::Lambert(reflectance("Kd", DEFAULT_DIFFUSE)?)
        };
        let without = if self.has("map_Ke") { Vec3::ONE } else { Vec3::ZERO };
        let emission = self.last("Ke").map_or(Ok(without), |line| colour(line, f32::MAX))?;
        if matches!(scattering, Scattering::Dielectric { .. }) {
            if self.last("Tf").is_some_and(|line| colour_of(line).is_none_or(|filter| filter != Vec3::ONE)) {
                notes.push("colour of the glass (Tf)".to_owned());
            }
        } else if let Some(field) = self.transparency() {
            notes.push(format!("transparency ({field})"));
        }
        Ok((Material::plain(name, scattering, emission), notes))
    }

    /// The last line of a field, which is the one that counts.
    fn last(&self, field: &str) -> Option<&Line<'_>> {
        self.statements.iter().rfind(|line| line.keyword().eq_ignore_ascii_case(field.as_bytes()))
    }

    /// The images that the material names and that are not read.
    fn other_textures(&self) -> Vec<String> {
        let named = OTHER_TEXTURES.iter().filter_map(|field| Some((field, self.last(field)?)));
        named.map(|(field, line)| format!("texture \"{}\" ({field})", shown(&image(line).name))).collect()
    }

    /// Whether the material has a field.
    pub(super) fn has(&self, field: &str) -> bool {
        self.last(field).is_some()
    }

    /// The image of `map_Kd` or `map_Ke`.
    pub(super) fn image(&self, field: &str) -> Option<ImageName> {
        self.last(field).map(image)
    }

    /// The field that makes the material transparent: `d` is opacity, `Tr` its opposite; programs that mix
    /// them up write both.
    fn transparency(&self) -> Option<&'static str> {
        let number = |field: &str| {
            let word = self.last(field)?.words().find(|word| *word != "-halo")?;
            word.parse().ok().filter(|number: &f32| number.is_finite())
        };
        match (number("d"), number("Tr")) {
            (Some(opacity), _) => (opacity < 1.0).then_some("d"),
            (None, Some(transparency)) => (transparency > 0.0).then_some("Tr"),
            (None, None) => None,
        }
    }

    /// A number in a range, whole if the range is that of the illumination models.
    fn number(&self, field: &'static str, least: f32, most: f32) -> Result<Option<f32>, Problem> {
        let Some(line) = self.last(field) else { return Ok(None) };
        let remedy = if field == "illum" {
            "give a whole number from 0 to 10"
        } else {
            "give a number from 0.1 to 10"
        };
        let problem = match line.numbers() {
            Err(problem) => problem,
            Ok((_, 0)) => "the number is missing".to_owned(),
            Ok(([number], _))
                if !(least..=most).contains(&number) || (field == "illum" && number.fract() != 0.0) =>
            {
                format!("{field} {number} is not possible")
            }
            Ok(([number], _)) => return Ok(Some(number)),
        };
        Err((format!("{}: {problem}", line.place()), remedy))
    }
}

/// A colour by one number for all channels, or three.
fn colour(line: &Line<'_>, most: f32) -> Result<Vec3, Problem> {
    let refuse = |problem: &str, remedy| Err((format!("{}: {problem}", line.place()), remedy));
    if let Some(kind @ ("spectral" | "xyz")) = line.words().next() {
        let problem = format!("colours by \"{kind}\" can't be read");
        return refuse(&problem, "give red, green and blue");
    }
    match line.numbers::<3>() {
        Err(problem) => refuse(&problem, "give red, green and blue, with a point before decimals"),
        Ok((_, count @ (0 | 2))) => refuse(
            &format!("it has {count} numbers"),
            "give red, green and blue, or one number for all three",
        ),
        Ok(_) => match colour_of(line)
            .filter(|colour| (0.0..=most).contains(&colour.min_element()) && colour.max_element() <= most)
        {
            Some(colour) => Ok(colour),
            None if most <= 1.0 => refuse("the reflectance is not possible", "it goes from 0 to 1"),
            None => refuse("the emission is not possible", "it starts at 0"),
        },
    }
}

fn colour_of(line: &Line<'_>) -> Option<Vec3> {
    match line.numbers::<3>() {
        Ok(([grey, _, _], 1)) => Some(Vec3::splat(grey)),
        Ok((numbers, 3)) => Some(Vec3::from_array(numbers)),
        _ => None,
    }
}

/// The image that a statement names.
pub(super) struct ImageName {
    /// Its file; the name may have blanks.
    pub(super) name: String,
    /// Whether its outermost texels continue it, instead of the image again (`-clamp on`).
    pub(super) clamped: bool,
    /// Other options that change it, as `-s`.
    pub(super) options: Vec<String>,
}

/// The name of an image, after its options.
fn image(line: &Line<'_>) -> ImageName {
    let whole = line.name().bare;
    let mut rest = whole.as_str();
    let mut found = ImageName { name: String::new(), clamped: false, options: Vec::new() };
    while rest.starts_with('-') {
        let (option, after) = split_word(rest);
        let (fewest, most) = match option {
            "-s" | "-o" | "-t" => (1, 3),
            "-mm" => (2, 2),
            _ => (1, 1),
        };
        rest = after;
        let mut value = "";
        for place in 0..most {
            let (word, after) = split_word(rest);
            if place >= fewest && word.parse::<f32>().is_err() {
                break;
            }
            (value, rest) = (word, after);
        }
        match option {
            "-clamp" => found.clamped = value == "on",
            // How it is filtered, which channel a grey one has, and colour correction that is off: nothing to
            // report.
            "-blendu" | "-blendv" | "-boost" | "-texres" | "-imfchan" | "-cc" => {}
            _ => found.options.push(option.to_owned()),
        }
    }
    rest.clone_into(&mut found.name);
    found
}

fn split_word(text: &str) -> (&str, &str) {
    text.split_once(|letter: char| letter.is_ascii_whitespace())
        .map_or((text, ""), |(word, rest)| (word, rest.trim_start()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn only(text: &str) -> Result<(Material, Vec<String>), Problem> {
        let text = format!("newmtl m\n{text}");
        entries(text.as_bytes()).remove(0).material("m".to_owned())
    }

    #[test]
    fn a_colour_has_one_number_or_three() {
        for (text, expected) in [
            ("Kd 0.6", [0.6; 3]),
            ("Kd .1 2e-1 +0.3", [0.1, 0.2, 0.3]),
            ("kd 1 1 1\n\tKd\t0 0 0 # black", [0.0; 3]),
        ] {
            let (material, notes) = only(text).unwrap();
            assert_eq!(material.scattering, Scattering::Lambert(Vec3::from_array(expected)), "{text}");
            assert!(notes.is_empty(), "{notes:?}");
        }
        for (text, problem) in [
            ("Kd", "line 2, `Kd`: it has 0 numbers"),
            ("Kd 0 1", "line 2, `Kd 0 1`: it has 2 numbers"),
            ("Kd 0,5", "line 2, `Kd 0,5`: `0,5` is not a finite number"),
            ("Kd 0 1.5 0", "line 2, `Kd 0 1.5 0`: the reflectance is not possible"),
            ("Kd 0 -1 0", "line 2, `Kd 0 -1 0`: the reflectance is not possible"),
            ("Kd spectral a.rfl", "line 2, `Kd spectral a.rfl`: colours by \"spectral\" can't be read"),
            ("Kd xyz 0.1", "line 2, `Kd xyz 0.1`: colours by \"xyz\" can't be read"),
            ("Ke inf 0 0", "line 2, `Ke inf 0 0`: `inf` is not a finite number"),
            ("Ke 0 0 -1", "line 2, `Ke 0 0 -1`: the emission is not possible"),
            ("illum 11", "line 2, `illum 11`: illum 11 is not possible"),
            ("illum 2.5", "line 2, `illum 2.5`: illum 2.5 is not possible"),
            ("illum", "line 2, `illum`: the number is missing"),
            ("illum 4\nNi 0", "line 3, `Ni 0`: Ni 0 is not possible"),
        ] {
            assert_eq!(only(text).unwrap_err().0, problem);
        }
    }

    #[test]
    fn fields_that_do_not_count_may_be_anything() {
        for text in
            ["Kd 0.5\nNi 0\nKs x\nKa\nNs 1,5\nTf\nd -halo 1\nillum 2.0\nfoo", "Ks 0.5\nillum 3\nKd 7 7"]
        {
            assert_eq!(only(text).unwrap().1, Vec::<String>::new(), "{text}");
        }
    }

    #[test]
    fn what_is_missing_or_left_out_is_said() {
        for (text, expected) in [
            ("Ns 10", vec!["no Kd, 0.8 is taken"]),
            ("illum 5", vec!["no Ks, 1 is taken"]),
            ("Kd 1\nd 0.5\nTr 0", vec!["transparency (d)"]),
            ("Kd 1\nd 1\nTr 1", vec![]),
            ("Kd 1\nTr 1", vec!["transparency (Tr)"]),
            ("Kd 1\nd -halo 0.5", vec!["transparency (d)"]),
            ("illum 4\nTf 1 0 0\nd 0", vec!["colour of the glass (Tf)"]),
            ("Kd 1\nbump -bm 2 my bark.png", vec!["texture \"my bark.png\" (bump)"]),
            ("map_Kd bark.png\nd 0.5", vec!["transparency (d)"]),
        ] {
            assert_eq!(only(text).unwrap().1, expected, "{text}");
        }
    }

    #[test]
    fn the_name_of_an_image_comes_after_its_options() {
        for (text, name, clamped, options) in [
            ("map_kd -s 2 2 -o 1 1 1 -clamp on my bark.png", "my bark.png", true, vec!["-s", "-o"]),
            ("map_Kd -mm 0 1 \\\n.\\lamp.png # on", ".\\lamp.png", false, vec!["-mm"]),
            ("map_Kd -clamp off -blendu on a.png", "a.png", false, vec![]),
            ("map_Kd -s", "", false, vec!["-s"]),
        ] {
            let text = format!("newmtl m\n{text}");
            let image = entries(text.as_bytes()).remove(0).image("map_Kd").unwrap();
            assert_eq!((image.name.as_str(), image.clamped), (name, clamped), "{text}");
            assert_eq!(image.options, options, "{text}");
        }
    }
}
