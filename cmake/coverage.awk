# awk -v root=<source tree>/ -f coverage.awk docs/measurements/coverage.md coverage.txt
# Compares what llvm-cov shows as not reached with the excuses in the fenced blocks of the first file: a line "FILE: source
# text", then indented lines that say why. Text, not numbers, so that excuses survive edits elsewhere in the file.

function trim(text) { gsub(/^[ \t]+|[ \t]+$/, "", text); return text }

FNR == NR {
  if (/^```/) { fenced = !fenced; key = ""; next }
  if (!fenced) next
  if (/^[^ ]/) {
    key = $0
    excused[key] = 0
    reason[key] = ""
  } else if (key != "") reason[key] = reason[key] trim($0)
  next
}

function flush_line() {
  if (line_text == "") return
  if (missed) {
    key = file ": " line_text
    if (key in excused) excused[key] = 1
    else {
      print file ":" line_number ": not reached" branch_text ": " line_text
      ++fault_count
    }
    ++missed_count
  }
  missed = 0; branch_text = ""
}

/^\/.*:$/ { flush_line(); line_text = ""; file = substr($0, 1, length($0) - 1); sub(root, "", file); ++file_count; next }

/^ *[0-9]+\|/ {
  flush_line()
  split($0, part, "|")
  line_number = trim(part[1])
  count = trim(part[2])
  line_text = trim(substr($0, index($0, "|") + length(part[2]) + 2))
  missed = (count == "0")
  if (count != "") ++line_count
  next
}

/Branch \(/ {
  ++branch_count
  if ($0 ~ /(True|False): 0[],]/) { missed = 1; branch_text = branch_text " " trim(substr($0, index($0, "["))) }
}

END {
  flush_line()
  for (key in excused) {
    if (!excused[key]) { print "docs/measurements/coverage.md excuses what was reached, or what is not there: " key; ++fault_count }
    if (reason[key] == "") { print "docs/measurements/coverage.md gives no reason: " key; ++fault_count }
  }
  if (line_count == 0 || branch_count == 0) { print "coverage: llvm-cov showed nothing"; ++fault_count }
  printf "coverage: %d files, %d lines, %d branches; %d lines not reached in whole, all but %d of them excused\n",
         file_count, line_count, branch_count, missed_count, fault_count
  exit fault_count > 0
}
