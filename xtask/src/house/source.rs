//! What one source file has: lines, functions, type names and imports, without its tests.

use std::path::{Path, PathBuf};

use anyhow::Context;
use proc_macro2::Span;
use syn::spanned::Spanned;
use syn::visit::{self, Visit};

use crate::files;

/// A file of a crate.
#[derive(Debug, Default)]
pub struct Source {
    /// Its file.
    pub path: PathBuf,
    /// Module path from the crate's root; empty for the root.
    pub module: Vec<String>,
    /// Lines, those of test modules left out.
    pub lines: usize,
    /// Each function with its lines.
    pub functions: Vec<(String, usize)>,
    /// Structs, enums, traits and type aliases.
    pub types: Vec<String>,
    /// Paths that it imports, or names from the root, as written.
    pub imports: Vec<Vec<String>>,
    /// Module paths of its files that are for tests alone.
    pub test_modules: Vec<Vec<String>>,
}

impl Source {
    /// Every file of the crate whose sources are in `folder`.
    pub fn of_crate(folder: &Path) -> anyhow::Result<Vec<Self>> {
        let files = files::below(folder, "rs")?;
        let read = |file: &PathBuf| {
            let source = Self::parse(folder, file, &files::text(file)?);
            source.with_context(|| file.display().to_string())
        };
        let mut sources = files.iter().map(read).collect::<anyhow::Result<Vec<_>>>()?;
        let of_tests: Vec<_> = sources
            .iter()
            .flat_map(|it| it.test_modules.clone())
            .collect();
        sources.retain(|it| !of_tests.iter().any(|test| it.module.starts_with(test)));
        Ok(sources)
    }

    fn parse(root: &Path, path: &Path, text: &str) -> anyhow::Result<Self> {
        let mut source = Self {
            path: path.to_owned(),
            module: module_of(root, path),
            lines: text.lines().count(),
            ..Self::default()
        };
        source.visit_file(&syn::parse_file(text)?);
        Ok(source)
    }

    fn function(&mut self, name: &syn::Ident, all: Span) {
        self.functions.push((name.to_string(), lines(all)));
    }
}

fn module_of(root: &Path, path: &Path) -> Vec<String> {
    let within = path.strip_prefix(root).unwrap_or(path).with_extension("");
    let mut module: Vec<_> = within
        .iter()
        .map(|it| it.to_string_lossy().into_owned())
        .collect();
    if module.last().is_some_and(|it| it == "mod")
        || (module.len() == 1 && ["lib", "main"].contains(&module[0].as_str()))
    {
        module.pop();
    }
    module
}

fn lines(span: Span) -> usize {
    span.end().line - span.start().line + 1
}

fn is_test(attributes: &[syn::Attribute]) -> bool {
    attributes.iter().any(|it| {
        it.path().is_ident("test")
            || (it.path().is_ident("cfg")
                && (it.parse_args::<syn::Ident>()).is_ok_and(|argument| argument == "test"))
    })
}

impl<'a> Visit<'a> for Source {
    fn visit_item(&mut self, item: &'a syn::Item) {
        let (attributes, name) = match item {
            syn::Item::Mod(it) => (&it.attrs, None),
            syn::Item::Fn(it) => (&it.attrs, None),
            syn::Item::Struct(it) => (&it.attrs, Some(&it.ident)),
            syn::Item::Enum(it) => (&it.attrs, Some(&it.ident)),
            syn::Item::Trait(it) => (&it.attrs, Some(&it.ident)),
            syn::Item::Type(it) => (&it.attrs, Some(&it.ident)),
            syn::Item::Impl(it) => (&it.attrs, None),
            syn::Item::Use(it) => (&it.attrs, None),
            syn::Item::Const(it) => (&it.attrs, None),
            _ => return visit::visit_item(self, item),
        };
        if is_test(attributes) {
            self.lines -= lines(item.span());
            if let syn::Item::Mod(syn::ItemMod {
                ident,
                content: None,
                ..
            }) = item
            {
                let module = [self.module.clone(), vec![ident.to_string()]];
                self.test_modules.push(module.concat());
            }
            return;
        }
        self.types.extend(name.map(ToString::to_string));
        visit::visit_item(self, item);
    }

    fn visit_item_fn(&mut self, item: &'a syn::ItemFn) {
        self.function(&item.sig.ident, item.span());
        visit::visit_item_fn(self, item);
    }

    fn visit_impl_item_fn(&mut self, item: &'a syn::ImplItemFn) {
        if is_test(&item.attrs) {
            self.lines -= lines(item.span());
            return;
        }
        self.function(&item.sig.ident, item.span());
        visit::visit_impl_item_fn(self, item);
    }

    fn visit_item_use(&mut self, item: &'a syn::ItemUse) {
        flatten(&item.tree, &mut Vec::new(), &mut self.imports);
    }

    fn visit_path(&mut self, path: &'a syn::Path) {
        let names: Vec<_> = (path.segments.iter())
            .map(|it| it.ident.to_string())
            .collect();
        if names.len() > 1 && ["crate", "super", "self"].contains(&names[0].as_str()) {
            self.imports.push(names);
        }
        visit::visit_path(self, path);
    }
}

fn flatten(tree: &syn::UseTree, before: &mut Vec<String>, imports: &mut Vec<Vec<String>>) {
    match tree {
        syn::UseTree::Path(it) => {
            before.push(it.ident.to_string());
            flatten(&it.tree, before, imports);
            before.pop();
        }
        syn::UseTree::Group(it) => it.items.iter().for_each(|it| flatten(it, before, imports)),
        syn::UseTree::Glob(_) => imports.push(before.clone()),
        syn::UseTree::Name(syn::UseName { ident })
        | syn::UseTree::Rename(syn::UseRename { ident, .. }) => {
            let mut path = before.clone();
            path.push(ident.to_string());
            imports.push(path);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tests_do_not_count_and_do_not_hide() {
        let text = "use super::b::{C, d::E};\nfn long() {\n    crate::x::y();\n}\n#[cfg(test)]\nmod tests {\n    \
                    use super::*;\n    struct Hidden;\n}\nstruct After;\n#[cfg(test)]\nmod fixture;\n";
        let source = Source::parse(Path::new("src"), Path::new("src/a/mod.rs"), text).unwrap();
        assert_eq!(source.module, ["a"]);
        assert_eq!(source.lines, 5);
        assert_eq!(source.functions, [("long".to_owned(), 3)]);
        assert_eq!(source.types, ["After"]);
        assert_eq!(source.test_modules, [["a", "fixture"]]);
        let imports: Vec<_> = source.imports.iter().map(|it| it.join("::")).collect();
        assert_eq!(imports, ["super::b::C", "super::b::d::E", "crate::x::y"]);
    }
}
