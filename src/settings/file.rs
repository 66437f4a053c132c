//! How settings are written to files: the laboratory's fields among the others, as files have always had
//! them.

use super::{
    Exactness, Faults, Laboratory, Matching, Method, Planning, Rule, SatBuild, SatSamples, Search, Settings,
    Split, Storage, Variation,
};

/// All fields in the order of a file.
#[derive(serde::Serialize, serde::Deserialize)]
#[serde(rename = "Settings")]
pub(super) struct Fields {
    #[serde(default, skip_serializing_if = "Rule::is_usual")]
    rule: Rule,
    search: Search,
    method: Method,
    split: Split,
    matching: Matching,
    sat_build: SatBuild,
    sat_samples: SatSamples,
    storage: Storage,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    variation: Option<Variation>,
    faults: Faults,
    exactness: Exactness,
    limited_mask: bool,
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    masked: bool,
    #[serde(default, skip_serializing_if = "Planning::is_usual")]
    planning: Planning,
}

impl From<Settings> for Fields {
    fn from(settings: Settings) -> Self {
        let Settings { rule, search, method, storage, limited_mask, masked, planning, laboratory } = settings;
        let Laboratory { split, matching, sat_build, sat_samples, variation, faults, exactness } = laboratory;
        Self {
            rule,
            search,
            method,
            split,
            matching,
            sat_build,
            sat_samples,
            storage,
            variation,
            faults,
            exactness,
            limited_mask,
            masked,
            planning,
        }
    }
}

impl From<Fields> for Settings {
    fn from(fields: Fields) -> Self {
        let Fields { split, matching, sat_build, sat_samples, variation, faults, exactness, .. } = fields;
        let Fields { rule, search, method, storage, limited_mask, masked, planning, .. } = fields;
        let laboratory = Laboratory { split, matching, sat_build, sat_samples, variation, faults, exactness };
        Self { rule, search, method, storage, limited_mask, masked, planning, laboratory }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A file that version 0.1.0 wrote.
    const USUAL: &str = concat!(
        r#"{"search":{"min_photons":25,"max_radius":32,"edges":"scale","order":"bracketed"},"#,
        r#""method":"sat","split":"larger","matching":"bits","sat_build":"scan","sat_samples":4,"#,
        r#""storage":"u32","faults":{"clamp_to_63":false,"border_test":false,"corner_test":false,"#,
        r#""swapped_axes":false,"sample_stride":false,"forgotten_strip":false,"float_ratio":false},"#,
        r#""exactness":"required","limited_mask":false}"#,
    );

    #[test]
    fn files_keep_their_fields_and_order() {
        assert_eq!(serde_json::to_string(&Settings::default()).expect("plain"), USUAL);
        assert_eq!(serde_json::from_str::<Settings>(USUAL).expect("a file"), Settings::default());
    }

    #[test]
    fn what_is_unusual_comes_back() {
        let settings = Settings {
            rule: Rule::Even,
            masked: true,
            planning: Planning::EachFrame,
            laboratory: Laboratory {
                variation: Some(Variation::UnfinishedTexels),
                faults: Faults::AS_PRINTED,
                exactness: Exactness::Waived,
                ..Settings::thesis().laboratory
            },
            ..Settings::thesis()
        };
        let text = serde_json::to_string(&settings).expect("plain");
        assert!(text.starts_with(r#"{"rule":"even","search":"#), "{text}");
        assert!(text.ends_with(r#""limited_mask":false,"masked":true,"planning":"each-frame"}"#), "{text}");
        assert_eq!(serde_json::from_str::<Settings>(&text).expect("a file"), settings);
    }
}
