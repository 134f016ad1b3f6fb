//! `US`: stages of USD.

super::codes! { US:
    USD_SYNTAX = "US001", Error, "the text of a USD layer has a mistake in its syntax";
    USD_DAMAGED = "US002", Error, "a binary layer or a package of USD is damaged";
    USD_UNSUPPORTED = "US003", Warning, "a part of a USD stage is not supported";
    USD_APPROXIMATE = "US004", Warning, "a part of a USD stage is shown approximately";
    USD_ARC = "US005", Warning, "an arc of a USD stage leads nowhere";
}
