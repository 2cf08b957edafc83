//! Nouns to words, tables and pictures.
