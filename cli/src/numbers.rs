//! Numbers in options: errors say what the option takes, instead of quoting a parser.

use std::fmt::Display;
use std::ops::RangeInclusive;
use std::str::FromStr;
use std::time::Duration;

/// A whole number in `range`.
pub(super) fn whole<T>(range: RangeInclusive<T>) -> impl Fn(&str) -> Result<T, String> + Clone
where
    T: Copy + Display + FromStr + PartialOrd,
{
    move |text| match text.parse() {
        Ok(number) if range.contains(&number) => Ok(number),
        _ => Err(words(&range)),
    }
}

/// A whole number that should be in `range`, and is checked where it is used: the error there says why the
/// range ends where it does.
pub(super) fn whole_checked_later<T>(range: RangeInclusive<T>) -> impl Fn(&str) -> Result<T, String> + Clone
where
    T: Copy + Display + FromStr,
{
    move |text| text.parse().map_err(|_| words(&range))
}

fn words<T: Display>(range: &RangeInclusive<T>) -> String {
    format!("give a whole number from {} to {}", range.start(), range.end())
}

/// A number with or without a fraction; `example` is one that makes sense. Its range is checked where it is
/// used.
pub(super) fn fraction<T: FromStr>(example: &'static str) -> impl Fn(&str) -> Result<T, String> + Clone {
    move |text| text.parse().map_err(|_| format!("give a number, such as {example}"))
}

/// A time with its unit.
pub(super) fn duration(text: &str) -> Result<Duration, String> {
    humantime::parse_duration(text)
        .map_err(|error| format!("give a time such as 90s, 10m or 1h 30m: {error}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_are_named() {
        let seed = whole(0..=u64::MAX);
        assert_eq!(seed("18446744073709551615"), Ok(u64::MAX));
        for text in ["-1", "18446744073709551616", "1.5", "1e3", "", " 1", "many"] {
            assert_eq!(seed(text), Err("give a whole number from 0 to 18446744073709551615".to_owned()));
        }
        assert_eq!(whole(1..=5_u32)("0"), Err("give a whole number from 1 to 5".to_owned()));
        assert_eq!(whole_checked_later(1..=5_u32)("0"), Ok(0));
        assert_eq!(whole_checked_later(1..=5_u32)("-1"), Err("give a whole number from 1 to 5".to_owned()));
    }

    #[test]
    fn fractions_are_numbers() {
        let stops = fraction::<f32>("-1.5");
        assert_eq!(stops("-0.25"), Ok(-0.25));
        for text in ["", "bright", "1,5", "0x1", "--"] {
            assert_eq!(stops(text), Err("give a number, such as -1.5".to_owned()), "{text}");
        }
    }

    #[test]
    fn times_need_a_unit() {
        assert_eq!(duration("1h 30m"), Ok(Duration::from_mins(90)));
        for text in ["5", "-5s", "", "soon"] {
            assert!(
                duration(text).is_err_and(|words| words.starts_with("give a time such as 90s")),
                "{text}"
            );
        }
    }
}
