//! Which device to open, as `--device` names it.

use std::fmt;
use std::str::FromStr;

/// Which device to open.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub enum DeviceChoice {
    /// The first that works: hardware EGL devices, software EGL devices, OSMesa.
    #[default]
    Auto,
    /// EGL devices only; of that index if one is given.
    Egl(Option<usize>),
    /// OSMesa only.
    OsMesa,
    /// The first whose renderer, vendor or device name contains this, whatever the case.
    Named(String),
}

impl DeviceChoice {
    /// Whether this asks for the candidate or platform `other`.
    pub(super) fn covers(&self, other: &Self) -> bool {
        match self {
            Self::Auto | Self::Named(_) => true,
            Self::Egl(None) => matches!(other, Self::Egl(_)),
            Self::Egl(Some(_)) => other == self || *other == Self::Egl(None),
            Self::OsMesa => other == self,
        }
    }
}

impl FromStr for DeviceChoice {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "" => Err("a device name can't be empty; try auto".to_owned()),
            "auto" => Ok(Self::Auto),
            "egl" => Ok(Self::Egl(None)),
            "osmesa" => Ok(Self::OsMesa),
            _ => match text.strip_prefix("egl:") {
                Some(index) => match index.parse() {
                    Ok(index) => Ok(Self::Egl(Some(index))),
                    Err(_) => Err(format!("\"{index}\" is not an index; `varikernel devices` lists them")),
                },
                None => Ok(Self::Named(text.to_owned())),
            },
        }
    }
}

impl fmt::Display for DeviceChoice {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Auto => formatter.write_str("auto"),
            Self::Egl(None) => formatter.write_str("egl"),
            Self::Egl(Some(index)) => write!(formatter, "egl:{index}"),
            Self::OsMesa => formatter.write_str("osmesa"),
            Self::Named(name) => formatter.write_str(name),
        }
    }
}
