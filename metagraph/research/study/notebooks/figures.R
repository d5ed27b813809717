# Every figure of a study's report once more, from its tables alone. Base R, no packages.
# Rscript figures.R TABLES OUT: the folder of the tables, and one for the figures (PDF).
given <- commandArgs(trailingOnly = TRUE)
tables <- if (length(given) > 0) given[1] else ".."
out <- if (length(given) > 1) given[2] else "."
dir.create(out, showWarnings = FALSE, recursive = TRUE)
get <- function(name) read.csv(file.path(tables, paste0(name, ".csv")), na.strings = "n/a", stringsAsFactors = FALSE)
paper <- function(name, width = 7, height = 5) pdf(file.path(out, paste0(name, ".pdf")), width = width, height = height)
interval <- function(x) { # mean with Student's interval
  n <- length(x)
  half <- if (n > 1) qt(0.975, n - 1) * sd(x) / sqrt(n) else NA
  c(mean(x), mean(x) - half, mean(x) + half)
}
people <- get("participants"); tasks <- get("tasks"); clips <- get("clips")
spent <- get("spent"); answers <- get("questionnaires"); estimates <- get("estimates")
meta <- grep("^meta_seconds", names(people), value = TRUE)[1]
manual <- grep("^manual_seconds", names(people), value = TRUE)[1]
both <- people[!is.na(people$ratio), ]
colours <- c(meta = "#127065", manual = "#a35c00", unreal = "#1a63b8", unity = "#6a45c4", godot = "#b3372f",
             blender = "#8a1c5c")

# participants
paper("participants", 6, 4)
barplot(table(people$standing), ylab = "people", main = "Who took part")
invisible(dev.off())

# times: each person's two times, with geometric means
if (nrow(both) > 0) {
  paper("times")
  matplot(c(1, 2), rbind(both[[meta]], both[[manual]]), type = "b", pch = 16, lty = 1, col = "grey50", log = "y",
          xaxt = "n", xlab = "", ylab = "seconds (logarithmic)", xlim = c(0.7, 2.3))
  axis(1, at = 1:2, labels = c("meta-graph", "state machine by hand"))
  for (k in 1:2) {
    e <- exp(interval(log(both[[c(meta, manual)[k]]])))
    points(k + c(-0.12, 0.12)[k], e[1], pch = 16, cex = 1.5, col = colours[k])
    if (!is.na(e[2])) segments(k + c(-0.12, 0.12)[k], e[2], k + c(-0.12, 0.12)[k], e[3], lwd = 2, col = colours[k])
  }
  invisible(dev.off())
  all <- exp(interval(log(both$ratio)))
  told <- estimates[estimates$sort == "reported", ]
  stopifnot(abs(all[1] - told$value) < 1e-3 * told$value) # R finds what the report tells
  cat(sprintf("ratio %.3f [%.3f, %.3f], n = %d\n", all[1], all[2], all[3], nrow(both)))
}

# ratios, and reckoned otherwise
forest <- function(rows, name) {
  paper(name, 7, 1.5 + 0.3 * nrow(rows))
  par(mar = c(4, 12, 1, 1))
  at <- rev(seq_len(nrow(rows)))
  plot(rows$value, at, log = "x", pch = 16, yaxt = "n", ylab = "", xlab = "ratio of times, by hand / meta-graph",
       xlim = range(c(1, rows$low, rows$high, rows$value), na.rm = TRUE), ylim = c(0.5, nrow(rows) + 0.5))
  there <- !is.na(rows$low) & !is.na(rows$high)
  segments(rows$low[there], at[there], rows$high[there], at[there], lwd = 2)
  abline(v = 1, lty = 2)
  axis(2, at = at, labels = rows$name, las = 1)
  invisible(dev.off())
}
shown <- estimates[estimates$sort %in% c("reported", "task"), ]
if (nrow(shown) > 0) forest(shown, "ratios")
shown <- estimates[estimates$sort %in% c("reported", "otherwise"), ]
if (nrow(shown) > 1) forest(shown, "otherwise")

# practice: seconds of the first, second ... clip
done <- tasks[tasks$finished == "yes" | tasks$timed_out == "yes", c("participant", "condition", "task", "index")]
worked <- merge(clips, done)
worked <- worked[worked$seconds > 0, ]
if (nrow(worked) > 0) {
  worked <- worked[order(worked$participant, worked$condition, worked$index, worked$number), ]
  worked$nth <- ave(worked$seconds, worked$participant, worked$condition, FUN = seq_along)
  mean_of <- aggregate(log(seconds) ~ condition + nth, worked, mean)
  paper("practice")
  plot(mean_of$nth, exp(mean_of[[3]]), log = "xy", pch = 16, col = colours[mean_of$condition],
       xlab = "the how-many-eth clip (logarithmic)", ylab = "seconds a clip (logarithmic)")
  for (c in unique(worked$condition)) {
    slopes <- sapply(split(worked[worked$condition == c, ], worked$participant[worked$condition == c]),
                     function(d) if (nrow(d) > 2) coef(lm(log(seconds) ~ log(nth), d)) else c(NA, NA))
    at <- c(1, max(worked$nth[worked$condition == c]))
    lines(at, exp(mean(slopes[1, ], na.rm = TRUE)) * at^mean(slopes[2, ], na.rm = TRUE), col = colours[c], lwd = 2)
    cat(sprintf("practice, %s: %.3f\n", c, mean(slopes[2, ], na.rm = TRUE)))
  }
  invisible(dev.off())
}

# where the time went
spent <- merge(spent, done)
if (nrow(spent) > 0) {
  many <- aggregate(task ~ participant + condition, done, length)
  each <- merge(aggregate(seconds ~ participant + condition + use, spent, sum), many)
  each$seconds <- each$seconds / each$task
  count <- table(many$condition)
  total <- aggregate(seconds ~ condition + use, each, sum)
  total$seconds <- total$seconds / as.numeric(count[total$condition])
  paper("spent", 8, 4)
  barplot(xtabs(seconds ~ use + condition, total), horiz = TRUE, legend.text = TRUE, xlab = "seconds a task, mean",
          args.legend = list(cex = 0.7, bty = "n"))
  invisible(dev.off())
}

# ratings
scores <- answers[answers$item == "score", ]
if (nrow(scores) > 0) {
  scores$value <- as.numeric(scores$value)
  groups <- split(scores$value, paste(scores$questionnaire, scores$condition))
  e <- t(sapply(groups, interval))
  paper("ratings", 7, 1.5 + 0.4 * nrow(e))
  par(mar = c(4, 10, 1, 1))
  at <- rev(seq_len(nrow(e)))
  plot(e[, 1], at, pch = 16, xlim = c(0, 100), yaxt = "n", ylab = "", xlab = "score, points of 100", ylim = c(0.5, nrow(e) + 0.5))
  there <- !is.na(e[, 2])
  segments(pmax(0, e[there, 2]), at[there], pmin(100, e[there, 3]), at[there], lwd = 2)
  axis(2, at = at, labels = rownames(e), las = 1)
  invisible(dev.off())
}
