//! Numbers of a glTF file: packed, apart, sparse, or zeros that are not stored.

use gltf_json::accessor::{ComponentType, GenericComponentType, IndexComponentType, Type};
use gltf_json::validation::Checked;
use gltf_json::{Accessor, Index};

use super::document::Document;
use super::{Problem, problem};

const REMEDY: &str = "export the mesh again";

/// What whole numbers mean where numbers with a fraction are asked for.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Whole {
    /// As the accessor says: themselves, or shares of the largest.
    AsSaid,
    /// Shares of the largest.
    Shares,
}

impl Document<'_> {
    /// Items of `N` numbers, all of them finite.
    ///
    /// # Errors
    /// If they have another number of components, are no such numbers, or are not all there.
    pub(super) fn floats<const N: usize>(
        &self,
        index: Index<Accessor>,
        whole: Whole,
        place: &str,
    ) -> Result<Vec<[f32; N]>, Problem> {
        let accessor = self.find(index, "accessor", place)?;
        let shares = whole == Whole::Shares || accessor.normalized;
        let items = self.items(accessor, place, |bytes, kind| float(bytes, kind, shares))?;
        if let Some(number) = items.iter().position(|item: &[f32; N]| !item.iter().all(|one| one.is_finite()))
        {
            let reason =
                format!("item {} is {:?}, and every number must be finite", number + 1, items[number]);
            return Err(problem(place, reason, REMEDY));
        }
        Ok(items)
    }

    /// Items of `N` whole numbers.
    ///
    /// # Errors
    /// As [`Document::floats`], and if they are not whole.
    pub(super) fn integers<const N: usize>(
        &self,
        index: Index<Accessor>,
        place: &str,
    ) -> Result<Vec<[u32; N]>, Problem> {
        let accessor = self.find(index, "accessor", place)?;
        if matches!(accessor.component_type, Checked::Valid(GenericComponentType(ComponentType::F32))) {
            return Err(problem(place, "it holds numbers with a fraction, not whole ones", REMEDY));
        }
        self.items(accessor, place, |bytes, _| integer(bytes))
    }

    /// Components of an item of an accessor.
    pub(super) fn width(&self, index: Index<Accessor>, place: &str) -> Result<usize, Problem> {
        match self.find(index, "accessor", place)?.type_ {
            Checked::Valid(kind) => Ok(kind.multiplicity()),
            Checked::Invalid => Err(problem(place, "its type is not known", REMEDY)),
        }
    }

    fn items<const N: usize, T: Copy + Default>(
        &self,
        accessor: &Accessor,
        place: &str,
        number: impl Fn(&[u8], ComponentType) -> T,
    ) -> Result<Vec<[T; N]>, Problem> {
        let (Checked::Valid(GenericComponentType(component)), Checked::Valid(kind)) =
            (accessor.component_type, accessor.type_)
        else {
            return Err(problem(place, "its type of numbers is not known", REMEDY));
        };
        if kind.multiplicity() != N || matches!(kind, Type::Mat2 | Type::Mat3) {
            let reason = format!("it holds {} and not {N} numbers an item", type_name(kind));
            return Err(problem(place, reason, REMEDY));
        }
        let count = accessor.count.0;
        let width = component.size();
        self.spend(count.saturating_mul((N * size_of::<T>()) as u64), place)?;
        let item = |bytes: &[u8]| -> [T; N] {
            std::array::from_fn(|at| number(&bytes[at * width..(at + 1) * width], component))
        };
        let mut items = match accessor.buffer_view {
            Some(view) => {
                let (bytes, stride) = self.view(view, format!("{place}: bufferView"))?;
                let start = accessor.byte_offset.unwrap_or_default().0;
                Strided::new(bytes, start, stride, N * width, count, place)?.map(item).collect()
            }
            None => vec![[T::default(); N]; usize::try_from(count).unwrap_or(0)],
        };
        if let Some(sparse) = &accessor.sparse {
            let place = format!("{place}: sparse");
            let Checked::Valid(IndexComponentType(component)) = sparse.indices.component_type else {
                return Err(problem(place, "its type of indices is not known", REMEDY));
            };
            let (bytes, _) = self.view(sparse.indices.buffer_view, format!("{place}.indices.bufferView"))?;
            let start = sparse.indices.byte_offset.0;
            let indices = Strided::new(bytes, start, None, component.size(), sparse.count.0, &place)?;
            let (bytes, _) = self.view(sparse.values.buffer_view, format!("{place}.values.bufferView"))?;
            let start = sparse.values.byte_offset.0;
            let values = Strided::new(bytes, start, None, N * width, sparse.count.0, &place)?;
            for (index, value) in indices.zip(values) {
                let index = integer(index) as usize;
                let count = items.len();
                *items.get_mut(index).ok_or_else(|| {
                    problem(&place, format!("it changes item {index} of {count}"), REMEDY)
                })? = item(value);
            }
        }
        Ok(items)
    }
}

/// The name of a type in the file.
fn type_name(kind: Type) -> &'static str {
    match kind {
        Type::Scalar => "SCALAR",
        Type::Vec2 => "VEC2",
        Type::Vec3 => "VEC3",
        Type::Vec4 => "VEC4",
        Type::Mat2 => "MAT2",
        Type::Mat3 => "MAT3",
        Type::Mat4 => "MAT4",
    }
}

/// Items at even distances.
struct Strided<'b> {
    bytes: &'b [u8],
    stride: usize,
    size: usize,
    left: u64,
}

impl<'b> Strided<'b> {
    /// `count` items of `size` bytes from byte `start` on.
    fn new(
        bytes: &'b [u8],
        start: u64,
        stride: Option<usize>,
        size: usize,
        count: u64,
        place: &str,
    ) -> Result<Self, Problem> {
        let stride = stride.unwrap_or(size);
        let needed = match count.checked_sub(1) {
            Some(steps) => steps.checked_mul(stride as u64).and_then(|last| last.checked_add(size as u64)),
            None => Some(0),
        };
        let rest = usize::try_from(start).ok().and_then(|start| bytes.get(start..));
        let (Some(rest), Some(needed)) = (rest, needed) else {
            return Err(past(place, count, start, bytes.len()));
        };
        if needed > rest.len() as u64 {
            return Err(past(place, count, start, bytes.len()));
        }
        Ok(Self { bytes: rest, stride, size, left: count })
    }
}

impl<'b> Iterator for Strided<'b> {
    type Item = &'b [u8];

    fn next(&mut self) -> Option<&'b [u8]> {
        self.left = self.left.checked_sub(1)?;
        let item = self.bytes.get(..self.size)?;
        self.bytes = self.bytes.get(self.stride..).unwrap_or_default();
        Some(item)
    }
}

fn past(place: &str, count: u64, start: u64, available: usize) -> Problem {
    let reason = format!(
        "{count} items from byte {start} on are past the end of its buffer view, which has {available}"
    );
    problem(place, reason, "copy or export the files of the mesh again")
}

/// A component as a number with a fraction. `bytes` are as many as the component has.
fn float(bytes: &[u8], kind: ComponentType, shares: bool) -> f32 {
    let share = |number: f32, most: f32| if shares { (number / most).max(-1.0) } else { number };
    match (kind, bytes) {
        (ComponentType::I8, &[a]) => share(f32::from(i8::from_le_bytes([a])), 127.0),
        (ComponentType::U8, &[a]) => share(f32::from(a), 255.0),
        (ComponentType::I16, &[a, b]) => share(f32::from(i16::from_le_bytes([a, b])), 32767.0),
        (ComponentType::U16, &[a, b]) => share(f32::from(u16::from_le_bytes([a, b])), 65535.0),
        (ComponentType::F32, &[a, b, c, d]) => f32::from_le_bytes([a, b, c, d]),
        #[expect(
            clippy::cast_precision_loss,
            reason = "no such numbers are allowed where a fraction is asked for"
        )]
        _ => integer(bytes) as f32,
    }
}

/// A component as a whole number. `bytes` are as many as the component has.
fn integer(bytes: &[u8]) -> u32 {
    let mut word = [0; 4];
    word[..bytes.len()].copy_from_slice(bytes);
    u32::from_le_bytes(word)
}
