//! Errors of the library in the words of the command line.

use varikernel::Error;

/// The words of `error` for a setting that an option gave.
pub(crate) fn in_words_of_options(error: Error) -> anyhow::Error {
    match error {
        Error::Setting { name, value, reason } => {
            anyhow::anyhow!("{} {value} is not possible: {reason}", option_of(name))
        }
        other => other.into(),
    }
}

/// The option that gives a field of the library's settings.
fn option_of(field: &str) -> String {
    match field {
        "faults" => "--fault".to_owned(),
        "order" => "--search".to_owned(),
        "masked" => "--mask".to_owned(),
        _ => format!("--{}", field.replace('_', "-")),
    }
}
