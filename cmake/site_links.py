# SPDX-License-Identifier: Apache-2.0
"""A hook of mkdocs: the site includes each file outside docs/ that a page links to, as text below
source/."""
import os
import re

from mkdocs.structure.files import File

LINK = re.compile(r"(\]\()(?!\w+:|#)([^)#\s]+)")


def outside(page_file, target, config):
    """Returns the file that a page's link leads to, relative to the repository; None where that is
    inside docs/, outside the repository or does not exist."""
    root = os.path.dirname(config["config_file_path"])
    page_folder = os.path.join(config["docs_dir"], os.path.dirname(page_file.src_uri))
    path = os.path.normpath(os.path.join(page_folder, target))
    inside = path.startswith(config["docs_dir"] + os.sep) or not path.startswith(root + os.sep)
    return None if inside or not os.path.isfile(path) else os.path.relpath(path, root)


def in_site(path):
    return f"source/{path}.txt"


def on_files(files, config):
    for page_file in list(files.documentation_pages()):
        with open(page_file.abs_src_path, encoding="utf-8") as text:
            links = LINK.findall(text.read())
        for path in {outside(page_file, target, config) for _, target in links} - {None}:
            if in_site(path) not in files.src_uris:
                source = File(in_site(path), config["docs_dir"], config["site_dir"],
                              config["use_directory_urls"])
                root = os.path.dirname(config["config_file_path"])
                source.abs_src_path = os.path.join(root, path)
                files.append(source)
    return files


def on_page_markdown(markdown, page, config, files):
    def rewritten(match):
        path = outside(page.file, match.group(2), config)
        if path is None:
            return match.group(0)
        page_folder = os.path.dirname(page.file.src_uri) or "."
        return match.group(1) + os.path.relpath(in_site(path), page_folder)

    return LINK.sub(rewritten, markdown)
