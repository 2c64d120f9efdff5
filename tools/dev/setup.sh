#!/usr/bin/env bash
# For developers, once a checkout: all packages, and a hook that checks format and stairs before a commit.
set -euo pipefail
cd "$(dirname "$0")/../.."
tools/dev/packages.sh all
git config core.hooksPath tools/dev/hooks
