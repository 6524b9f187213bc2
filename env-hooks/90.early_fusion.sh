# ROS's Python tools start with "#!/usr/bin/env python3" and need the system's interpreter. If another python3 (pyenv,
# conda, a venv) is first on PATH and has no rospkg, /usr/bin is put in front of it.
if ! python3 -c 'import rospkg, yaml' >/dev/null 2>&1 && /usr/bin/python3 -c 'import rospkg' >/dev/null 2>&1; then
  export PATH="/usr/bin:$PATH"
fi
